#pragma once

#include <functional>
#include <utility>

#include "vm_protocol/core/scheduler.h"

namespace vm {

/// At most one pending action, which is cancelled with its owner. Lifetime: the scheduler outlives
/// it. Thread: the scheduler's.
class Timer {
 public:
  explicit Timer(Scheduler& clock) : clock_(clock) {}
  ~Timer() { Cancel(); }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  /// Replaces the pending action. While `action` runs it is not pending any more.
  void At(Time when, std::function<void()> action) {
    Cancel();
    id_ = clock_.At(when, [this, action = std::move(action)] {
      id_ = 0;
      action();
    });
  }
  void Cancel() {
    if (pending()) clock_.Cancel(std::exchange(id_, 0));
  }
  bool pending() const { return id_ != 0; }

 private:
  Scheduler& clock_;
  TimerId id_ = 0;
};

}  // namespace vm
