#pragma once

#include <memory>
#include <string>
#include <utility>

#include "ssm/voice/audio_sink.h"
#include "vm_protocol/runtime/asio_scheduler.h"

namespace ssm {

/// A loudspeaker cannot follow a clock that jumps. So each utterance goes to the device while the
/// clock is real, and to a silent sink on the same clock while it is not (a hub making a film).
/// Lifetime: the clock outlives it.
class RealTimeSink final : public AudioSink {
 public:
  RealTimeSink(vm::ClockScheduler& clock, std::unique_ptr<AudioSink> device)
      : clock_(clock), silent_(clock), device_(std::move(device)) {}

  vm::Result<void> Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) override {
    playing_ = clock_.real() ? device_.get() : &silent_;
    return playing_->Play(std::move(samples), start);
  }
  Position Where() const override { return playing_->Where(); }
  Position Stop() override { return playing_->Stop(); }
  std::string name() const override { return device_->name(); }

 private:
  vm::ClockScheduler& clock_;
  ClockSink silent_;
  const std::unique_ptr<AudioSink> device_;
  AudioSink* playing_ = &silent_;
};

}  // namespace ssm
