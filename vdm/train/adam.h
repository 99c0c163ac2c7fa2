#pragma once

#include "vdm/train/gradient.h"

namespace vdm {

/// The steps of Adam (Kingma and Ba, 2015) with decoupled weight decay (Loshchilov and Hutter,
/// 2019). Its state is part of what is kept to resume a training.
struct Adam {
  explicit Adam(const TimeDelayNet& net) : mean(net), square(net) {}
  /// One step down the gradient.
  void Step(TimeDelayNet& net, const NetGradient& gradient, double rate);

  NetGradient mean, square;
  long steps = 0;
};

}  // namespace vdm
