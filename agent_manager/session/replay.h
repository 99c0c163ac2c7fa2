#pragma once

#include <set>
#include <string>
#include <vector>

#include "agent_manager/log/session_log.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// A session log whose clients' lines are said again, at the times they were said.
/// Thread: the scheduler's.
class Replay {
 public:
  /// `modules`: who answers by itself now, as it did then. Throws std::runtime_error with a
  /// sentence if the log cannot be read.
  Replay(vm::Scheduler& clock, Hub& hub, const std::string& path, std::set<std::string> modules,
         double speed);
  /// `on_said` is called before each line. Throws std::runtime_error if the name REPLAY is taken.
  void Start(std::function<void()> on_said);
  /// Lines still to be said.
  std::size_t pending() const { return pending_; }

 private:
  vm::Scheduler& clock_;
  Hub& hub_;
  double speed_;
  std::vector<LogEntry> entries_;
  std::size_t pending_ = 0;
};

}  // namespace am
