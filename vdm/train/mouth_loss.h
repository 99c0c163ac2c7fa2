#pragma once

#include <Eigen/Core>
#include <vector>

#include "vdm/net/mouth_net.h"

namespace vdm {

/// What the mouth truly is at each instant of a sound, in the order of a MouthNet's outputs.
struct MouthTruth {
  Eigen::MatrixXf shape;           ///< kShapeNumbers x instants, in their own units
  Eigen::VectorXf closed;          ///< 0 .. 1
  std::vector<std::size_t> sound;  ///< index into MouthNet::sounds
};

/// What outputs should be: the scaled shape, how likely closed lips are, and how likely each sound.
/// A column for each instant; mixtures of such matrices are such matrices.
Eigen::MatrixXf WantedOf(const MouthNet& net, const MouthTruth& truth);
/// The same as a net's outputs say it: what another net can learn from it.
Eigen::MatrixXf WantedOf(const MouthNet& net, Eigen::MatrixXf outputs);

/// How far outputs are from what they should be, summed over instants, and how it changes with each
/// output: half the squared error of the scaled shape (jaw and opening of the lips count more, and
/// the shape counts less where the lips are closed, since there nobody sees it), cross-entropy of
/// the closure and, with less weight, of the sounds. REQUIRES: as many columns in both.
struct MouthLoss {
  double shape = 0, closure = 0, sounds = 0;
  double total() const { return shape + closure + sounds; }
};
MouthLoss LossOf(const MouthNet& net, const Eigen::MatrixXf& outputs, const Eigen::MatrixXf& wanted,
                 Eigen::MatrixXf& slope);

}  // namespace vdm
