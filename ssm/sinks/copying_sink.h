#pragma once

#include <memory>
#include <string>

#include "ssm/voice/audio_sink.h"

namespace ssm {

/// Another sink, and a copy of what is heard for a program that listens at a Unix socket, with the
/// time of every sample: docs/speech.md, Sound for other programs. Samples go out up to kAhead
/// before they are heard, as soon as they are made. Nothing waits for the receiver.
/// Ownership: owns the sink and its end of the socket. Thread: the scheduler's; a timer is pending
/// only while there is a receiver and something plays or waits for it.
/// Limits: of more than kMaxWaitingBytes that the receiver has not taken, the newest are dropped;
/// one that has taken nothing for kStall is cut off.
class CopyingSink final : public AudioSink {
 public:
  static constexpr vm::Time kStep{40'000};
  static constexpr vm::Time kAhead{400'000};
  static constexpr vm::Time kStall{2'000'000};
  static constexpr std::size_t kMaxWaitingBytes = 256u * 1024;

  CopyingSink(vm::Scheduler& scheduler, std::unique_ptr<AudioSink> sink);
  ~CopyingSink() override;

  /// "unix:PATH" of a socket somebody listens at, or "NONE"; the receiver before is let go.
  /// Errors: kBadValue, kUnavailable; there is no receiver then.
  vm::Result<void> SendTo(const std::string& to);
  /// The receiver as SendTo was given it; "NONE" once it has gone.
  std::string to();

  vm::Result<void> Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) override;
  Position Where() const override { return sink_->Where(); }
  Position Stop() override;
  std::string name() const override { return sink_->name(); }

 private:
  void Step();
  void Copy();
  void Send(const std::string& record);
  void Flush();
  void Arm();
  void LetGo();

  vm::Scheduler& scheduler_;
  const std::unique_ptr<AudioSink> sink_;
  std::shared_ptr<const SampleBuffer> samples_;  // while something plays
  std::size_t copied_ = 0;                       // frames of it
  std::string to_ = "NONE";
  int fd_ = -1;
  std::string waiting_;     // whole records, but for the first, whose beginning may be sent
  vm::Time last_taken_{0};  // when the receiver has last taken anything
  vm::TimerId timer_ = 0;
};

}  // namespace ssm
