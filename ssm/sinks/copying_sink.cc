#include "ssm/sinks/copying_sink.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <span>
#include <utility>

#include "vm_protocol/runtime/unix_socket.h"

namespace ssm {
namespace {

constexpr const char* kNobody = "NONE";

/// `at`: when the first of them is heard.
std::string SoundRecord(vm::Time at, std::span<const std::int16_t> samples) {
  std::string record = "sound " + vm::FormatMs(at) + " " + std::to_string(kSampleRateHz) + " " +
                       std::to_string(samples.size() * 2) + "\n";
  for (const std::int16_t sample : samples) {
    const auto bits = static_cast<std::uint16_t>(sample);
    record += static_cast<char>(bits & 0xFF);
    record += static_cast<char>(bits >> 8);
  }
  return record;
}

}  // namespace

CopyingSink::CopyingSink(vm::Scheduler& scheduler, std::unique_ptr<AudioSink> sink)
    : scheduler_(scheduler), sink_(std::move(sink)) {}

CopyingSink::~CopyingSink() { LetGo(); }

vm::Result<void> CopyingSink::SendTo(const std::string& to) {
  LetGo();
  if (to == kNobody) return {};
  constexpr std::string_view kUnix = "unix:";
  if (!to.starts_with(kUnix)) {
    return vm::Fail(vm::Errc::kBadValue, "found '" + to + "', expected NONE or unix:PATH");
  }
  const auto fd = vm::ConnectUnix(to.substr(kUnix.size()));
  if (!fd)
    return vm::Fail(fd.error().code, "nobody takes sound at '" + to + "': " + fd.error().text);
  fd_ = *fd;
  to_ = to;
  last_taken_ = scheduler_.Now();
  if (samples_) copied_ = Where().frames;
  Step();
  return {};
}

std::string CopyingSink::to() {
  char byte;
  if (fd_ >= 0 && recv(fd_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0) LetGo();
  return to_;
}

void CopyingSink::LetGo() {
  if (timer_ != 0) scheduler_.Cancel(std::exchange(timer_, 0));
  if (fd_ >= 0) close(std::exchange(fd_, -1));
  waiting_.clear();
  to_ = kNobody;
}

vm::Result<void> CopyingSink::Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) {
  auto played = sink_->Play(samples, start);
  if (!played) return played;
  samples_ = std::move(samples);
  copied_ = 0;
  Step();
  return played;
}

AudioSink::Position CopyingSink::Stop() {
  if (fd_ >= 0) Copy();
  const Position end = sink_->Stop();
  samples_.reset();
  if (fd_ >= 0) {
    Send("end " + vm::FormatMs(end.first_frame + ToTime(end.frames)) + "\n");
    Arm();
  }
  return end;
}

void CopyingSink::Step() {
  if (fd_ < 0) return;
  if (samples_) Copy();
  Flush();
  Arm();
}

void CopyingSink::Arm() {
  if (timer_ != 0) scheduler_.Cancel(std::exchange(timer_, 0));
  if (fd_ < 0 || (waiting_.empty() && !(samples_ && copied_ < samples_->size()))) return;
  timer_ = scheduler_.After(kStep, [this] {
    timer_ = 0;
    Step();
  });
}

void CopyingSink::Copy() {
  const Position where = Where();
  const auto ready = samples_->Ready();
  const std::size_t until = where.frames > 0
                                ? where.frames + FramesIn(kAhead)
                                : FramesIn(scheduler_.Now() + kAhead - where.first_frame);
  // What was due before it was made has been silence.
  copied_ = std::max(copied_, where.frames);
  const std::size_t end = std::min(ready.size(), until);
  if (end <= copied_) return;
  Send(SoundRecord(where.first_frame + ToTime(copied_), ready.subspan(copied_, end - copied_)));
  copied_ = end;
}

void CopyingSink::Send(const std::string& record) {
  if (waiting_.size() + record.size() <= kMaxWaitingBytes) waiting_ += record;
  Flush();
}

void CopyingSink::Flush() {
  while (!waiting_.empty()) {
    const ssize_t n = send(fd_, waiting_.data(), waiting_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      if (errno != EAGAIN || scheduler_.Now() - last_taken_ > kStall) LetGo();
      return;
    }
    waiting_.erase(0, static_cast<std::size_t>(n));
    last_taken_ = scheduler_.Now();
  }
  last_taken_ = scheduler_.Now();
}

}  // namespace ssm
