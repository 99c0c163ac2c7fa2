#pragma once

#include <memory>
#include <string>

#include "ssm/voice/samples.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace ssm {

/// Where sound goes: one utterance at a time.
/// Thread: the scheduler's, for all calls; an implementation may read the samples on another.
class AudioSink {
 public:
  struct Position {
    std::size_t frames = 0;   ///< heard so far
    vm::Time first_frame{0};  ///< when frame 0 was heard, or will be
    bool failed = false;      ///< the device is gone; no further progress
  };

  virtual ~AudioSink() = default;
  /// Frame 0 is heard at `start`, or as soon after it as the device can.
  /// Error: kUnavailable with a sentence; nothing plays then. REQUIRES: nothing is playing.
  virtual vm::Result<void> Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) = 0;
  /// Where playing is. REQUIRES: Play was called and Stop was not.
  virtual Position Where() const = 0;
  /// Ends playing, after the last frame or before: silence within kMaxStopDelay. Returns what has
  /// been heard in the end. REQUIRES: as Where.
  virtual Position Stop() = 0;
  /// "null", "portaudio:NAME", "file:PATH".
  virtual std::string name() const = 0;

  static constexpr vm::Time kMaxStopDelay{50'000};
};

/// No sound, but exact time: frames pass with the scheduler's clock, real or virtual.
class ClockSink : public AudioSink {
 public:
  explicit ClockSink(vm::Scheduler& scheduler) : scheduler_(scheduler) {}
  vm::Result<void> Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) override;
  Position Where() const override;
  Position Stop() override;
  std::string name() const override { return "null"; }

 protected:
  const SampleBuffer* playing() const { return samples_.get(); }

 private:
  vm::Scheduler& scheduler_;
  std::shared_ptr<const SampleBuffer> samples_;
  vm::Time start_{0};
};

}  // namespace ssm
