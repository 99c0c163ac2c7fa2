#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace vm {

/// A point on a process's own clock, counted from that process's start. The hub measures the
/// offset between the clocks of its peers and translates (`@T` in values is in milliseconds).
using Time = std::chrono::microseconds;

/// "1234.5": milliseconds with at most three decimals, no trailing zeros; as written on the wire.
std::string FormatMs(Time time);
/// The same as a number, with its fraction.
inline double InMs(Time time) { return std::chrono::duration<double, std::milli>(time).count(); }
/// The reverse; accepts any finite decimal number of milliseconds within +-1e12.
Result<Time> ParseMs(std::string_view text);

using TimerId = std::uint64_t;

/// Time, injected: the only way any code here learns the time or waits. The same code runs on the
/// real clock (ClockScheduler, in vm_protocol/runtime) and on a virtual one (below).
/// Thread: one; callbacks run on the thread that runs the scheduler, never inside At().
class Scheduler {
 public:
  virtual ~Scheduler() = default;
  virtual Time Now() const = 0;
  /// Calls `action` once at `when` (or as soon as possible if that has passed). Timers of the same
  /// instant run in the order they were set. The id is never 0.
  virtual TimerId At(Time when, std::function<void()> action) = 0;
  /// A cancelled timer never runs; an id already run or unknown is ignored.
  virtual void Cancel(TimerId id) = 0;

  TimerId After(Time delay, std::function<void()> action) {
    return At(Now() + delay, std::move(action));
  }
  /// Soon, after what is already due, without time passing.
  TimerId Post(std::function<void()> action) { return At(Now(), std::move(action)); }
};

/// A clock that stands still until told: runs due timers in order, jumping from one to the next.
/// Exact to the microsecond, as fast as the work allows.
class VirtualScheduler final : public Scheduler {
 public:
  Time Now() const override { return now_; }
  TimerId At(Time when, std::function<void()> action) override;
  void Cancel(TimerId id) override;

  /// When the next timer is due; none = nothing to wait for.
  std::optional<Time> Next() const;
  /// Runs everything due up to and including `until`, then stands at `until`.
  void RunUntil(Time until);
  /// Runs timers until none is left or Now() would pass `limit`. True if none is left.
  bool RunUntilIdle(Time limit);
  /// Runs what is due now, without letting time pass.
  void RunReady() { RunUntil(now_); }
  std::size_t pending() const { return timers_.size(); }

 private:
  Time now_{0};
  TimerId last_id_ = 0;
  std::map<std::pair<Time, TimerId>, std::function<void()>> timers_;
  std::map<TimerId, Time> when_;
};

}  // namespace vm
