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

MouthLoss LossOf(const MouthNet& net, const Eigen::MatrixXf& outputs, const MouthTruth& truth,
                 Eigen::MatrixXf& slope) {
  MouthLoss loss;
  slope.setZero(outputs.rows(), outputs.cols());
  const auto closure_row = static_cast<Eigen::Index>(net.closure_row());
  const auto first_sound = static_cast<Eigen::Index>(net.first_sound_row());
  const Eigen::Index sounds = outputs.rows() - first_sound;
  for (Eigen::Index t = 0; t < outputs.cols(); ++t) {
    const float closed = truth.closed[t];
    const float seen = 1 - (1 - kClosedShape) * closed;
    for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(kShapeNumbers); ++i) {
      const auto k = static_cast<std::size_t>(i);
      const float wanted = (truth.shape(i, t) - net.means[k]) / net.scales[k];
      const float error = outputs(i, t) - wanted, weight = ShapeWeight(i) * seen;
      loss.shape += 0.5 * static_cast<double>(weight * error * error);
      slope(i, t) = weight * error;
    }
    // log(1 + e^x) - y x, written so that no exponential overflows.
    const float x = outputs(closure_row, t);
    loss.closure += static_cast<double>(
        kClosureWeight * (std::max(x, 0.0F) + std::log1p(std::exp(-std::abs(x))) - closed * x));
    slope(closure_row, t) = kClosureWeight * (1 / (1 + std::exp(-x)) - closed);

    const auto logits = outputs.col(t).tail(sounds);
    const float most = logits.maxCoeff();
    const float sum = (logits.array() - most).exp().sum();
    const auto right = static_cast<Eigen::Index>(truth.sound[static_cast<std::size_t>(t)]);
    loss.sounds += static_cast<double>(kSoundsWeight * (std::log(sum) + most - logits[right]));
    slope.col(t).tail(sounds) = kSoundsWeight * (logits.array() - most).exp() / sum;
    slope(first_sound + right, t) -= kSoundsWeight;
  }
  return loss;
}

}  // namespace vdm
