#pragma once

#include "vm_protocol/core/scheduler.h"

namespace fsm {

/// The times of the frames of a film: frame k is at start + k / rate, exact to the microsecond for
/// films of any length.
struct FrameSeries {
  vm::Time start{0};
  double per_second = 30;

  vm::Time TimeOf(long frame) const {
    return start + vm::Time(static_cast<vm::Time::rep>(
                       static_cast<double>(frame) * 1e6 / per_second + 0.5));
  }
};

}  // namespace fsm
