#pragma once

#include <chrono>

namespace am {

enum class Restart { kNever, kOnFailure, kAlways };

/// When a module that has ended is started again: after `first`, doubling up to `longest`; after
/// more than `tries` starts within `within` not at all.
struct RestartPolicy {
  using Millis = std::chrono::milliseconds;
  Restart when = Restart::kOnFailure;
  Millis first{200};
  Millis longest{10000};
  unsigned tries = 8;
  Millis within{60000};
  bool operator==(const RestartPolicy&) const = default;
};

}  // namespace am
