#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <functional>
#include <optional>

#include "vm_protocol/core/scheduler.h"

namespace vm {

/// A scheduler whose clock can be the real one or stand under someone's hand, and be switched while
/// running: the same timers, two ways of passing time.
///   real:    time is the monotonic clock since construction; timers run from the io_context.
///   virtual: time moves only by Advance() and AdvanceToNext(); timers run inside those.
/// Switching to real goes on from the virtual time reached. Thread: the io_context's.
class ClockScheduler final : public Scheduler {
 public:
  explicit ClockScheduler(boost::asio::io_context& io, bool real);
  Time Now() const override;
  TimerId At(Time when, std::function<void()> action) override;
  void Cancel(TimerId id) override;

  bool real() const { return real_; }
  void UseReal();
  void UseVirtual();
  std::optional<Time> Next() const { return timers_.Next(); }
  /// Virtual only: runs everything due up to `until` and stands there. The past is ignored.
  void Advance(Time until);
  /// Virtual only: to the next timer's instant, running all due then. False if there is none.
  bool AdvanceToNext();

 private:
  void Arm();
  void Drive();
  VirtualScheduler timers_;
  boost::asio::steady_timer wake_;
  bool real_;
  std::chrono::steady_clock::time_point base_;  // real: when time was 0
  std::optional<Time> armed_for_;
  bool driving_ = false;
};

}  // namespace vm
