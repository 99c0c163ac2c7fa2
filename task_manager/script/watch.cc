#include "task_manager/script/watch.h"

#include <malloc.h>
#include <pthread.h>

#include <utility>

#include "task_manager/script/sanitized.h"

#ifdef GALATEA_SANITIZED
extern "C" std::size_t __sanitizer_get_current_allocated_bytes();
#endif

namespace vxml::script {
namespace {

/// Between two looks; a script overruns its limits by no more than it does in this time.
constexpr std::chrono::milliseconds kBetweenLooks{5};

std::chrono::nanoseconds TimeOn(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace

std::size_t AllocatedBytes() {
#ifdef GALATEA_SANITIZED
  return __sanitizer_get_current_allocated_bytes();
#else
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
#endif
}

Watch::Watch(std::function<void()> interrupt) : interrupt_(std::move(interrupt)) {
  pthread_getcpuclockid(pthread_self(), &clock_);
  thread_ = std::thread([this] { Run(); });
}

Watch::~Watch() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void Watch::Begin(std::chrono::nanoseconds time, std::size_t bytes,
                  const std::function<void()>& on_stuck) {
  const std::lock_guard lock(mutex_);
  running_ = true;
  verdict_ = Verdict::kWell;
  latest_ = TimeOn(clock_) + time;
  bytes_ = bytes;
  most_bytes_ = 0;
  on_stuck_ = &on_stuck;
  if (asleep_) wake_.notify_one();
}

Watch::Verdict Watch::End() {
  const std::lock_guard lock(mutex_);
  running_ = false;
  return verdict_;
}

Watch::Verdict Watch::verdict() {
  const std::lock_guard lock(mutex_);
  return verdict_;
}

Watch::Verdict Watch::Look() {
  if (TimeOn(clock_) > latest_) return Verdict::kLate;
  // Counting takes too long for the many scripts that end before the first look.
  const std::size_t allocated = AllocatedBytes();
  if (most_bytes_ == 0) most_bytes_ = allocated + bytes_;
  return allocated > most_bytes_ ? Verdict::kStarved : Verdict::kWell;
}

void Watch::Run() {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    if (!running_) {
      asleep_ = true;
      wake_.wait(lock, [this] { return running_ || stop_; });
      asleep_ = false;
    }
    wake_.wait_for(lock, kBetweenLooks, [this] { return stop_; });
    if (!running_) continue;
    if (verdict_ == Verdict::kWell) {
      verdict_ = Look();
      stuck_from_ = TimeOn(clock_) + kGrace;
    }
    if (verdict_ == Verdict::kWell) continue;
    interrupt_();
    if (*on_stuck_ && TimeOn(clock_) > stuck_from_) (*on_stuck_)();
  }
}

}  // namespace vxml::script
