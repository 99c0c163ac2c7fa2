#pragma once

#include <memory>
#include <span>
#include <string>

#include "ssm/voice/wav_file.h"
#include "vm_protocol/core/scheduler.h"

namespace ssm {

/// What was heard from one instant to another, as a WAV file whose frame 0 is that instant: speech
/// where it was played, silence between. On a virtual clock exact to the sample.
/// Limits: kMaxLength; what is heard later is not kept.
/// Errors: kUnavailable from the file, which keeps what was written of it: the text says how much.
class Tape {
 public:
  static constexpr vm::Time kMaxLength = std::chrono::hours(24);

  static vm::Result<std::unique_ptr<Tape>> Start(const std::string& path, vm::Time now);

  /// `heard` begins at the instant `at`. What lies before the tape's beginning, or before the end
  /// of what was added earlier, is left out.
  vm::Result<void> Add(vm::Time at, std::span<const std::int16_t> heard);
  /// Silence up to `now`; the file is complete then. Call once, last.
  vm::Result<void> Close(vm::Time now);

 private:
  Tape(std::unique_ptr<WavWriter> file, vm::Time start) : file_(std::move(file)), start_(start) {}
  vm::Result<void> Told(vm::Result<void> written) const;
  vm::Result<void> SilenceUntil(std::size_t frame);
  std::unique_ptr<WavWriter> file_;
  const vm::Time start_;
};

}  // namespace ssm
