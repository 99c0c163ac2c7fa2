#pragma once

#include <Eigen/Core>
#include <vector>

#include "vdm/net/time_delay_net.h"
#include "vdm/train/dice.h"

namespace vdm {

/// What changes the loss of a network: for each layer as its weights and biases.
struct NetGradient {
  struct Layer {
    Eigen::MatrixXf weights;
    Eigen::VectorXf biases;
  };
  std::vector<Layer> layers;

  /// Zero, in the shapes of `net`.
  explicit NetGradient(const TimeDelayNet& net);
  void SetZero();
  void Add(const NetGradient& other);
};

/// Back-propagation through a time-delay network. Keeps what Forward computed until Backward.
/// Lifetime: the network outlives it. Thread: one; instances of their own may share a network.
class BackPropagation {
 public:
  explicit BackPropagation(const TimeDelayNet& net) : net_(net), steps_(net.layers.size()) {}
  /// From now on each hidden unit is as much larger or smaller as the dice say: a factor between
  /// 1 - 2 strength and 1 + 2 strength, the same throughout a sound (the continuous dropout of
  /// Kaldi's networks: Povey and others, Semi-orthogonal low-rank matrix factorization for deep
  /// neural networks, 2018). So a network cannot rely on single units. `strength`: 0 .. 0.5.
  void Disturb(double strength, Dice& dice);
  /// As net.Outputs(input).
  const Eigen::MatrixXf& Forward(const Eigen::MatrixXf& input);
  /// `slope`: how the loss changes with each output of the last Forward. Adds to `gradient`; writes
  /// how it changes with each input to `input_slope`, if there is one.
  void Backward(const Eigen::MatrixXf& slope, NetGradient& gradient,
                Eigen::MatrixXf* input_slope = nullptr);

 private:
  struct Step {
    Eigen::MatrixXf gathered, outputs;
    Eigen::VectorXf factors{};  ///< of Disturb, a number for each unit; none: undisturbed
  };
  const TimeDelayNet& net_;
  std::vector<Step> steps_;
};

}  // namespace vdm
