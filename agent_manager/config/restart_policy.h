#pragma once

#include <chrono>

namespace am {

enum class Restart { kNever, kOnFailure, kAlways };

/// When to restart a module that has ended: after `first`, then after delays that double up to
/// `longest`; never again after more than `tries` starts within `within`.
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
