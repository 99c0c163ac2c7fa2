#pragma once

#include <memory>
#include <string>

#include "ssm/voice/audio_sink.h"
#include "vm_protocol/core/scheduler.h"

namespace ssm {

/// What `--sink` says: auto | null | portaudio[:NAME] | file:PATH | raw:PATH
struct SinkChoice {
  enum class Kind { kAuto, kNull, kPortAudio, kFile, kRaw };
  Kind kind = Kind::kAuto;
  std::string argument;  ///< the device's name or the file's path
};
/// Error: kBadValue naming the five.
vm::Result<SinkChoice> ParseSinkChoice(const std::string& text);

struct OpenedSink {
  std::unique_ptr<AudioSink> sink;
  std::string notice;  ///< for people: why `auto` became null; else empty
};
/// `auto` is PortAudio's default device, or null if there is none.
/// Throws std::runtime_error with a sentence if what was asked for cannot be had.
OpenedSink OpenSink(const SinkChoice& choice, vm::Scheduler& scheduler);

}  // namespace ssm
