#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "gateway/speech/speech_request.h"
#include "ssm/process/voice_process.h"
#include "vdm/net/mouth_net.h"

namespace gateway {

struct SpeechAnswer {
  std::string media_type{};
  std::string body{};
};
/// The sound as it was asked for, alone or, with a set, in JSON beside phonemes, visemes and frames
/// (docs/gateway.md). Compressed sound comes from ffmpeg. Errors: kUnavailable, kTimeout, kStopped.
vm::Result<SpeechAnswer> MakeSpeechAnswer(const SpeechRequest& request, const ssm::Spoken& spoken,
                                          const vdm::MouthNet& net,
                                          const std::atomic<bool>& cancelled);

}  // namespace gateway
