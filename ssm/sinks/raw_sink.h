#pragma once

#include <string>

#include "ssm/voice/audio_sink.h"

namespace ssm {

/// Bare samples, 16 bit little endian, to a pipe (FIFO), device or file, as they are heard, for
/// another program to play or send on. A pipe without a reader loses them; nothing waits.
/// Thread: the scheduler's. Timers run only while something plays.
class RawSink final : public ClockSink {
 public:
  static constexpr vm::Time kStep{20'000};  ///< how often samples are handed over

  /// Throws std::runtime_error if the path cannot be opened for writing.
  RawSink(vm::Scheduler& scheduler, const std::string& path);
  ~RawSink() override;
  vm::Result<void> Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) override;
  Position Stop() override;
  std::string name() const override { return "raw:" + path_; }

 private:
  void Step();
  void Write();

  vm::Scheduler& scheduler_;
  const std::string path_;
  int fd_ = -1;  // ours
  std::size_t written_ = 0;
  vm::TimerId timer_ = 0;
};

}  // namespace ssm
