#pragma once

#include <string>
#include <string_view>

#include "gateway/face/weight_sets.h"

namespace gateway {

/// How sound is sent: what the client calls it, and how ffmpeg makes it (empty: we do).
struct SoundFormat {
  std::string_view name, media_type;
  std::string_view muxer;
};
/// wav, pcm (24 kHz), mp3, opus, aac, flac. Null for any other.
const SoundFormat* FindSoundFormat(std::string_view name);

/// What a client of POST /v1/audio/speech wants.
struct SpeechRequest {
  std::string text{};   ///< one line without markup, not blank
  std::string voice{};  ///< empty: the voice's own choice
  double speed = 1;     ///< 0.25 to 4
  const SoundFormat* format = nullptr;
  const WeightSet* set = nullptr;  ///< of the frames beside the sound; null: the sound alone
  unsigned fps = 50;
};
/// Whether a name is that of a voice of OpenAI's service, which its clients send whatever there is.
bool IsVoiceOfOpenAi(std::string_view name);

inline constexpr std::size_t kMaxSpokenBytes = 8192;  // as the voice's Text takes

/// Reads a request's body; `model` and unknown members do not count. kBadValue, kSyntax, kTooLong.
vm::Result<SpeechRequest> ReadSpeechRequest(std::string_view body);

}  // namespace gateway
