#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fsm/motion/inputs/emotion_space.h"
#include "vdm/net/time_delay_net.h"
#include "vdm/train/gradient.h"

namespace facespace {

/// The network of the emotion space while it learns: ratios of units in, the same ratios out,
/// through a middle of three. Its layers have no biases (they are kept at zero), so that twice the
/// ratios are twice the point.
struct IdentityNet {
  vdm::TimeDelayNet encoder, decoder;

  /// Five layers with weights by chance, the same for the same `seed`: units, `hidden` of them, 3,
  /// `hidden`, units.
  IdentityNet(Eigen::Index units, Eigen::Index hidden, std::uint64_t seed);
};

/// Expressions to learn from; a column each.
struct Lesson {
  Eigen::MatrixXf inputs;   ///< ratios, disturbed
  Eigen::MatrixXf targets;  ///< ratios that are to come out
  Eigen::MatrixXf points;   ///< 3 numbers: where they are led to
  Eigen::VectorXf led;      ///< how strongly each is led there, 0 = not at all
};

/// Slopes of both halves.
struct IdentityGradient {
  explicit IdentityGradient(const IdentityNet& net) : encoder(net.encoder), decoder(net.decoder) {}
  vdm::NetGradient encoder, decoder;
};

/// The loss of a lesson: half the mean square by which ratios come out otherwise, and half the mean
/// square of the way to the points they are led to. Thread: one. The network outlives it.
class IdentityLoss {
 public:
  explicit IdentityLoss(const IdentityNet& net) : encoder_(net.encoder), decoder_(net.decoder) {}
  /// Also puts the slopes of all weights into `gradient`; those of biases are zero.
  double Of(const Lesson& lesson, IdentityGradient& gradient);

 private:
  vdm::BackPropagation encoder_, decoder_;
};

}  // namespace facespace
