#pragma once

#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"
#include "vm_protocol/core/scheduler.h"

namespace vm {

/// When something shall start, as written in values:
///   NOW | +MS | + MS | +HH:MM:SS[.mmm] | HH:MM:SS[.mmm] (wall clock, local) | @MS (this clock)
struct StartTime {
  enum class Kind { kNow, kAfter, kWallClock, kAt };
  Kind kind = Kind::kNow;
  Time time{0};  ///< kAfter: delay from receipt; kWallClock: since local midnight; kAt: the instant

  bool operator==(const StartTime&) const = default;
};

/// Any case of NOW; blanks allowed after '+' and '@'. Errors: kBadValue. A delay is at most 24 h.
Result<StartTime> ParseStartTime(std::string_view text);
std::string FormatStartTime(const StartTime& start);

/// The instant on the clock whose present reading is `now`. `wall_since_midnight` is the local
/// wall time at that same moment; a wall time that has passed today means tomorrow, except within
/// the last minute, which means at once (the line was on its way).
Time Resolve(const StartTime& start, Time now, Time wall_since_midnight);

/// Local wall time since midnight, from the system clock. (The only reading of it here.)
Time WallSinceMidnight();

}  // namespace vm
