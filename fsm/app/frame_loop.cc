#include "fsm/app/frame_loop.h"

#include <algorithm>
#include <cmath>

#include "fsm/app/frame_series.h"

namespace fsm {
namespace {

/// Returns the first instant of the grid after `t`.
vm::Time FrameAfter(vm::Time t, double per_second) {
  const FrameSeries grid{vm::Time(0), per_second};
  auto k = static_cast<long>(std::floor(static_cast<double>(t.count()) * per_second / 1e6));
  while (grid.TimeOf(k) <= t) ++k;
  return grid.TimeOf(k);
}

}  // namespace

void FrameLoop::OnChange() {
  changed_ = true;
  Arm();
  WaitForRest();
}

void FrameLoop::Arm() {
  const auto wanted = subject_.wanted();
  if (!wanted) return timer_.Cancel();
  const vm::Time now = clock_.Now();
  std::optional<vm::Time> due;
  if (const auto motion = subject_.next_motion(now)) {
    due = FrameAfter(std::max(now, *motion), wanted->per_second);
  }
  // The effect of a command is shown in the next frame, even if nothing moves by it, and commands
  // do not put off a frame that is due already.
  if (changed_) {
    due = FrameAfter(now, wanted->per_second);
  } else if (wanted->in_window) {
    due = std::min(due.value_or(vm::Time::max()), now + kWindowEvents);
  }
  if (!due) return timer_.Cancel();
  if (timer_.pending() && due_ <= *due) return;
  due_ = *due;
  timer_.At(due_, [this] { Show(); });
}

void FrameLoop::Show() {
  changed_ = false;
  if (subject_.show(clock_.Now())) Arm();
}

void FrameLoop::WaitForRest() {
  // The timer wakes those who wait for the end of all movement, and the virtual clock only advances
  // to times of timers.
  const vm::Time rest = subject_.rests_at(clock_.Now());
  if (rest_timer_.pending() && rest == rest_due_) return;
  if (rest <= clock_.Now()) return rest_timer_.Cancel();
  rest_due_ = rest;
  rest_timer_.At(rest, [this] { WaitForRest(); });
}

}  // namespace fsm
