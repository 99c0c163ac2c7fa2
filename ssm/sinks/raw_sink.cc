#include "ssm/sinks/raw_sink.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

namespace ssm {

RawSink::RawSink(vm::Scheduler& scheduler, const std::string& path)
    : ClockSink(scheduler), scheduler_(scheduler), path_(path) {
  // A FIFO opened for writing only would wait for its reader, or fail.
  struct stat status {};
  const bool fifo = stat(path.c_str(), &status) == 0 && S_ISFIFO(status.st_mode);
  const int flags = fifo ? O_RDWR : O_WRONLY | O_CREAT | O_TRUNC;
  fd_ = open(path.c_str(), flags | O_NONBLOCK | O_CLOEXEC, 0666);
  if (fd_ < 0) throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno));
}

RawSink::~RawSink() {
  if (timer_ != 0) scheduler_.Cancel(timer_);
  close(fd_);
}

vm::Result<void> RawSink::Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) {
  written_ = 0;
  auto played = ClockSink::Play(std::move(samples), start);
  if (played) timer_ = scheduler_.At(std::max(start, scheduler_.Now()) + kStep, [this] { Step(); });
  return played;
}

void RawSink::Step() {
  timer_ = 0;
  Write();
  if (written_ < playing()->size()) timer_ = scheduler_.After(kStep, [this] { Step(); });
}

void RawSink::Write() {
  const auto ready = playing()->Ready();
  const std::size_t heard = Where().frames;
  std::vector<char> bytes;
  for (; written_ < heard; ++written_) {
    const std::int16_t sample = written_ < ready.size() ? ready[written_] : std::int16_t{0};
    const auto bits = static_cast<std::uint16_t>(sample);
    bytes.push_back(static_cast<char>(bits & 0xFF));
    bytes.push_back(static_cast<char>(bits >> 8));
  }
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t n = write(fd_, bytes.data() + at, bytes.size() - at);
    if (n < 0 && errno != EINTR) return;  // nobody reads: what does not fit is lost
    if (n > 0) at += static_cast<std::size_t>(n);
  }
}

AudioSink::Position RawSink::Stop() {
  if (timer_ != 0) scheduler_.Cancel(std::exchange(timer_, 0));
  Write();
  return ClockSink::Stop();
}

}  // namespace ssm
