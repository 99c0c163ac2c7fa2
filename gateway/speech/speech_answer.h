#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "gateway/speech/speech_request.h"
#include "vdm/net/mouth_net.h"
#include "vm_protocol/core/phonemes.h"

namespace gateway {

/// What a voice made of a text. 16 kHz mono.
struct Spoken {
  std::vector<std::int16_t> samples{};
  vm::PhonemeList phonemes{};
};

struct SpeechAnswer {
  std::string media_type{};
  std::string body{};
};
/// The sound as it was asked for, alone or, with a set, in JSON beside phonemes, visemes and frames
/// (docs/gateway.md). Compressed sound comes from ffmpeg. Errors: kUnavailable, kTimeout, kStopped.
vm::Result<SpeechAnswer> MakeSpeechAnswer(const SpeechRequest& request, const Spoken& spoken,
                                          const vdm::MouthNet& net,
                                          const std::atomic<bool>& cancelled);

}  // namespace gateway
