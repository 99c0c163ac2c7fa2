#pragma once

#include <functional>

#include "agent_manager/routing/hub.h"

namespace am {

/// On the real clock: whether the modules have nothing to do, found out by asking them while
/// somebody wants to know. Each module answers after all that was said to it before; guests are not
/// asked, so that none of them keeps the session from its end.
/// Thread: the scheduler's.
class QuietWatch {
 public:
  QuietWatch(vm::Scheduler& clock, Hub& hub, std::function<bool()> busy_here);
  /// Something was said: they may be busy again.
  void Disturb() { quiet_ = false; }
  bool quiet() const { return quiet_; }
  /// Asks, unless it is known or being asked already.
  void Ask();

 private:
  vm::Scheduler& clock_;
  Hub& hub_;
  std::function<bool()> busy_here_;
  bool quiet_ = false;
  bool asking_ = false;
};

}  // namespace am
