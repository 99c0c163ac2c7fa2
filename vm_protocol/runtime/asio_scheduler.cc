#include "vm_protocol/runtime/asio_scheduler.h"

#include <utility>

namespace vm {

ClockScheduler::ClockScheduler(boost::asio::io_context& io, bool real)
    : wake_(io), real_(real), base_(std::chrono::steady_clock::now()) {}

Time ClockScheduler::Now() const {
  if (!real_) return timers_.Now();
  return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now() - base_);
}

TimerId ClockScheduler::At(Time when, std::function<void()> action) {
  const TimerId id = timers_.At(when, std::move(action));
  if (real_ && !driving_) Arm();
  return id;
}

void ClockScheduler::Cancel(TimerId id) { timers_.Cancel(id); }

void ClockScheduler::UseReal() {
  if (real_) return;
  base_ = std::chrono::steady_clock::now() - timers_.Now();
  real_ = true;
  Arm();
}

void ClockScheduler::UseVirtual() {
  if (!real_) return;
  timers_.RunUntil(Now());  // what was due by now has happened
  real_ = false;
  armed_for_.reset();
  wake_.cancel();
}

void ClockScheduler::Advance(Time until) {
  if (!real_) timers_.RunUntil(until);
}

bool ClockScheduler::AdvanceToNext() {
  const auto next = timers_.Next();
  if (real_ || !next) return false;
  timers_.RunUntil(*next);
  return true;
}

void ClockScheduler::Arm() {
  const auto next = timers_.Next();
  if (!next || (armed_for_ && *armed_for_ <= *next)) return;
  armed_for_ = next;
  wake_.expires_at(base_ + *next);  // cancels an earlier wait
  wake_.async_wait([this, due = *next](const boost::system::error_code& error) {
    if (error || !real_ || armed_for_ != due) return;
    armed_for_.reset();
    Drive();
  });
}

void ClockScheduler::Drive() {
  // One instant at a time: a module that has fallen behind (frames to draw, say) must still hear
  // what is said to it between two of them.
  driving_ = true;
  const auto go_on = [this] {
    driving_ = false;
    if (real_) Arm();
  };
  try {
    if (const auto next = timers_.Next(); next && *next <= Now()) timers_.RunUntil(*next);
  } catch (...) {  // is the one timer's error: the others run all the same
    go_on();
    throw;
  }
  go_on();
}

}  // namespace vm
