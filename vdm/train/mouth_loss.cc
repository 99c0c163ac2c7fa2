#include "vdm/train/mouth_loss.h"

#include <algorithm>
#include <cmath>

namespace vdm {
namespace {

constexpr float kClosureWeight = 2, kSoundsWeight = 0.3F;
constexpr float kClosedShape = 0.3F;  // weight of the shape behind closed lips

float ShapeWeight(Eigen::Index row) {
  switch (row) {
    case 2:  // upper lip, inner Y
    case 4:  // lower lip, inner Y
    case 8:  // corners
      return 0.3F;
    case 11:  // jaw
      return 1.0F;
    default:
      return 0.1F;
  }
}

}  // namespace

Eigen::MatrixXf WantedOf(const MouthNet& net, const MouthTruth& truth) {
  const auto first_sound = static_cast<Eigen::Index>(net.first_sound_row());
  const auto sounds = static_cast<Eigen::Index>(net.sounds.size());
  Eigen::MatrixXf wanted = Eigen::MatrixXf::Zero(first_sound + sounds, truth.shape.cols());
  for (Eigen::Index t = 0; t < wanted.cols(); ++t) {
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kShapeNumbers); ++i) {
      const auto k = static_cast<std::size_t>(i);
      wanted(i, t) = (truth.shape(i, t) - net.means[k]) / net.scales[k];
    }
    wanted(static_cast<Eigen::Index>(net.closure_row()), t) = truth.closed[t];
    wanted(first_sound + static_cast<Eigen::Index>(truth.sound[static_cast<std::size_t>(t)]), t) =
        1;
  }
  return wanted;
}

Eigen::MatrixXf WantedOf(const MouthNet& net, Eigen::MatrixXf outputs) {
  auto closure = outputs.row(static_cast<Eigen::Index>(net.closure_row())).array();
  closure = 1 / (1 + (-closure).exp());
  const auto sounds = static_cast<Eigen::Index>(net.sounds.size());
  for (Eigen::Index t = 0; t < outputs.cols(); ++t) {
    auto logits = outputs.col(t).tail(sounds);
    logits = (logits.array() - logits.maxCoeff()).exp().eval();
    logits /= logits.sum();
  }
  return outputs;
}

MouthLoss LossOf(const MouthNet& net, const Eigen::MatrixXf& outputs, const Eigen::MatrixXf& wanted,
                 Eigen::MatrixXf& slope) {
  MouthLoss loss;
  slope.setZero(outputs.rows(), outputs.cols());
  const auto sounds = static_cast<Eigen::Index>(net.sounds.size());
  const auto closure_row = static_cast<Eigen::Index>(net.closure_row());
  for (Eigen::Index t = 0; t < outputs.cols(); ++t) {
    const float closed = wanted(closure_row, t);
    const float seen = 1 - (1 - kClosedShape) * closed;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kShapeNumbers); ++i) {
      const float error = outputs(i, t) - wanted(i, t), weight = ShapeWeight(i) * seen;
      loss.shape += 0.5 * static_cast<double>(weight * error * error);
      slope(i, t) = weight * error;
    }
    // log(1 + e^x) - y x, written so that no exponential overflows.
    const float x = outputs(closure_row, t);
    loss.closure += static_cast<double>(
        kClosureWeight * (std::max(x, 0.0F) + std::log1p(std::exp(-std::abs(x))) - closed * x));
    slope(closure_row, t) = kClosureWeight * (1 / (1 + std::exp(-x)) - closed);

    const auto logits = outputs.col(t).tail(sounds);
    const auto likely = wanted.col(t).tail(sounds);
    const float most = logits.maxCoeff();
    const float sum = (logits.array() - most).exp().sum();
    loss.sounds += static_cast<double>(kSoundsWeight * (std::log(sum) + most - likely.dot(logits)));
    slope.col(t).tail(sounds) =
        kSoundsWeight * ((logits.array() - most).exp() / sum - likely.array());
  }
  return loss;
}

}  // namespace vdm
