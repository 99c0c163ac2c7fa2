#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "vm_protocol/core/timer.h"

namespace fsm {

/// Schedules the frames that are shown in the window or reported outside films. Frames are on a
/// fixed grid of the clock, so that the same commands give the same reports: each of the grid while
/// something moves, and the next one after a command. A window is also shown every kWindowEvents. A
/// timer is pending only while frames are wanted and due, and until all is at rest. Lifetime: the
/// clock outlives this. Thread: the scheduler's.
class FrameLoop {
 public:
  static constexpr vm::Time kWindowEvents{200'000};

  struct Wanted {
    double per_second;
    bool in_window = false;
  };
  /// What the frames show.
  struct Subject {
    /// Which frames are wanted now, if any.
    std::function<std::optional<Wanted>()> wanted;
    /// As FaceMotion::NextMotion.
    std::function<std::optional<vm::Time>(vm::Time)> next_motion;
    /// Returns when everything that has an end will be over; no later than the argument: it is.
    std::function<vm::Time(vm::Time)> rests_at;
    /// Shows the frame of an instant. False: none is shown any more.
    std::function<bool(vm::Time)> show;
  };
  FrameLoop(vm::Scheduler& clock, Subject subject) : clock_(clock), subject_(std::move(subject)) {}

  /// Says that the subject may look or move differently now.
  void OnChange();
  bool AtRest() const { return subject_.rests_at(clock_.Now()) <= clock_.Now(); }
  /// Shows no frame until the next change.
  void Stop() { timer_.Cancel(); }

 private:
  void Arm();
  void Show();
  void WaitForRest();

  vm::Scheduler& clock_;
  Subject subject_;
  vm::Timer timer_{clock_};
  vm::Time due_{0};
  bool changed_ = false;  // since the last frame
  vm::Timer rest_timer_{clock_};
  vm::Time rest_due_{0};
};

}  // namespace fsm
