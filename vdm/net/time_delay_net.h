#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

namespace vdm {

/// One layer of a time-delay network: y_t = f(W [x_{t+o1}; x_{t+o2}; ...] + b). What lies before
/// the first or after the last vector is zero.
struct TimeDelayLayer {
  std::vector<int> offsets{};  ///< o1 < o2 < ..., in vectors of the input; at least one
  std::size_t inputs = 0;      ///< numbers in an input vector
  Eigen::MatrixXf weights{};   ///< outputs x (inputs * offsets)
  Eigen::VectorXf biases{};
  bool rectified = true;  ///< f cuts at zero; false: f is the identity

  std::size_t outputs() const { return static_cast<std::size_t>(weights.rows()); }
};

/// A time-delay network (Waibel and others, Phoneme recognition using time-delay neural networks,
/// 1989; in the form of Peddinti and others, A time delay neural network architecture for efficient
/// modeling of long temporal contexts, 2015): layers, each of which sees some vectors before and
/// after its own of the layer below. A plain value.
struct TimeDelayNet {
  std::vector<TimeDelayLayer> layers{};

  std::size_t inputs() const { return layers.front().inputs; }
  std::size_t outputs() const { return layers.back().outputs(); }
  /// How many vectors after its own, and before it, an output depends on.
  std::size_t ahead() const;
  std::size_t behind() const;
  std::size_t parameters() const;

  /// All outputs of a whole sound: columns are instants.
  Eigen::MatrixXf Outputs(const Eigen::MatrixXf& input) const;
};

/// The columns of `input` at each offset, one above the other: what a layer's weights multiply.
void Gather(const Eigen::MatrixXf& input, const std::vector<int>& offsets, Eigen::MatrixXf& out);

}  // namespace vdm
