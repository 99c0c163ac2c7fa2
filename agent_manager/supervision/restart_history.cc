#include "agent_manager/supervision/restart_history.h"

#include <algorithm>

namespace am {

std::optional<RestartPolicy::Millis> RestartHistory::NextDelay(const RestartPolicy& policy,
                                                               bool failed, Time now) {
  if (policy.when == Restart::kNever || (policy.when == Restart::kOnFailure && !failed))
    return std::nullopt;
  while (!starts_.empty() && now - starts_.front() > policy.within) starts_.pop_front();
  if (starts_.size() > policy.tries) {
    gave_up_ = true;
    return std::nullopt;
  }
  delay_ = starts_.size() <= 1 ? policy.first : std::min(delay_ * 2, policy.longest);
  return delay_;
}

void RestartHistory::Forgive() {
  starts_.clear();
  delay_ = RestartPolicy::Millis(0);
  gave_up_ = false;
}

}  // namespace am
