#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace sound {

/// Where sound comes from: 16 kHz, 16 bit, mono, at the pace of time.
/// Thread: the scheduler's, for calls and for events.
class AudioSource {
 public:
  struct Events {
    std::function<void(std::span<const std::int16_t>)> sound;
    std::function<void()> ended;  ///< there is no more; the source is stopped already
    std::function<void(const vm::Error&)> failed;  ///< likewise
  };
  virtual ~AudioSource() = default;  ///< stops; no event follows
  virtual vm::Result<void> Start(Events events) = 0;
  /// True if it ends by itself (a file).
  virtual bool Ends() const = 0;
};

/// A recording, exactly in time on any clock, in steps of kStep, with kTail of silence after it so
/// that the last utterance ends.
class RecordedSource final : public AudioSource {
 public:
  static constexpr vm::Time kStep{20'000};
  static constexpr vm::Time kTail{2'000'000};
  RecordedSource(vm::Scheduler& scheduler, std::vector<std::int16_t> samples);
  ~RecordedSource() override;
  vm::Result<void> Start(Events events) override;
  bool Ends() const override { return true; }

 private:
  void Step();
  vm::Scheduler& scheduler_;
  std::vector<std::int16_t> samples_;
  Events events_;
  vm::Time start_{0};
  std::size_t next_ = 0;
  vm::TimerId timer_ = 0;
};

}  // namespace sound
