#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "vdm/net/time_delay_net.h"

namespace vdm {

/// A network over a stream: a vector goes in, and what it completes comes out, each output as soon
/// as net.ahead() further vectors are there. The outputs are those of TimeDelayNet::Outputs but
/// for rounding. Each layer works once per vector and keeps what the next one may still need.
/// Lifetime: the network outlives it. Thread: none of its own; one instance, one thread.
class NetStream {
 public:
  explicit NetStream(const TimeDelayNet& net);
  /// The output of the instant net.ahead() vectors ago, or an empty one at the beginning.
  const Eigen::VectorXf& Add(const Eigen::VectorXf& vector);

 private:
  /// The input of one layer: its last vectors, in a ring.
  struct Stage {
    Eigen::MatrixXf ring;
    Eigen::Index count = 0;  // vectors that came
    Eigen::VectorXf gathered;
  };
  const TimeDelayNet& net_;
  std::vector<Stage> stages_;
  Eigen::VectorXf now_;
};

}  // namespace vdm
