#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include "agent_manager/config/restart_policy.h"

namespace am {

/// The starts of one module, and what follows from them. Pure: the caller says what time it is.
class RestartHistory {
 public:
  using Time = std::chrono::steady_clock::time_point;
  void Started(Time now) { starts_.push_back(now); }
  /// How long to wait before the next start; none = it is not started again.
  std::optional<RestartPolicy::Millis> NextDelay(const RestartPolicy& policy, bool failed,
                                                 Time now);
  /// True after NextDelay refused because of too many starts.
  bool gave_up() const { return gave_up_; }
  std::size_t recent() const { return starts_.size(); }
  /// A person starts it by hand: the past is forgiven.
  void Forgive();

 private:
  std::deque<Time> starts_;
  RestartPolicy::Millis delay_{0};
  bool gave_up_ = false;
};

}  // namespace am
