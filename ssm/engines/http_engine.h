#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "ssm/voice/speech_engine.h"
#include "vm_protocol/http/endpoint.h"
#include "vm_protocol/http/http_caller.h"

namespace ssm {

/// A voice behind an OpenAI-compatible address: each sentence is one POST to /v1/audio/speech,
/// whose sound comes whole; `align` finds the phonemes (of English with the text, else as they
/// sound). Where it finds none the sound is heard all the same, and the plan says so.
/// The voice's own pitch stays; `speed` goes from 0.25 to 4.
/// Errors name the address and never the key: kUnavailable, kAccess, kBusy (the server's words),
/// kTimeout, kTooLong, kBadValue (what came is no sound).
struct HttpVoiceOptions {
  std::string name{};
  std::string language = "en";
  bool female = false;
  vm::ServerSettings server{};
  std::string model{};
  std::string voice{};
  std::string format = "wav";     ///< wav, pcm or mp3 (which ffmpeg decodes)
  std::int64_t rate_hz = 24'000;  ///< of pcm, which does not say it
  std::string aligner{};          ///< path of align; empty: no phonemes
};
std::unique_ptr<SpeechEngine> MakeHttpEngine(HttpVoiceOptions options);

/// What came as sound, 16 kHz mono: WAV wherever it begins as WAV, else what `format` says. Pure
/// but for mp3 and WAV, which go through files of ours.
vm::Result<std::vector<std::int16_t>> SoundOf(const vm::HttpAnswer& answer,
                                              const std::string& format, std::int64_t rate_hz,
                                              const std::atomic<bool>& cancelled);

}  // namespace ssm
