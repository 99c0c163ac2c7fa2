#include "face_space/emotion/identity_net.h"

#include <cmath>

#include "vdm/train/dice.h"

namespace facespace {
namespace {

vdm::TimeDelayLayer LayerByChance(Eigen::Index inputs, Eigen::Index outputs, bool rectified,
                                  vdm::Dice& dice) {
  vdm::TimeDelayLayer layer{.offsets = {0},
                            .inputs = static_cast<std::size_t>(inputs),
                            .weights = Eigen::MatrixXf(outputs, inputs),
                            .biases = Eigen::VectorXf::Zero(outputs),
                            .rectified = rectified};
  // He and others, Delving deep into rectifiers, 2015; evenly spread, as that takes no logarithm,
  // which differs between machines.
  const double most = std::sqrt(6.0 / static_cast<double>(inputs));
  for (Eigen::Index i = 0; i < layer.weights.size(); ++i) {
    layer.weights.data()[i] = static_cast<float>(dice.Between(-most, most));
  }
  return layer;
}

}  // namespace

IdentityNet::IdentityNet(Eigen::Index units, Eigen::Index hidden, std::uint64_t seed) {
  vdm::Dice dice(seed);
  encoder.layers.push_back(LayerByChance(units, hidden, true, dice));
  encoder.layers.push_back(LayerByChance(hidden, 3, false, dice));
  decoder.layers.push_back(LayerByChance(3, hidden, true, dice));
  decoder.layers.push_back(LayerByChance(hidden, units, false, dice));
}

double IdentityLoss::Of(const Lesson& lesson, IdentityGradient& gradient) {
  gradient.encoder.SetZero();
  gradient.decoder.SetZero();
  const auto count = static_cast<float>(lesson.targets.cols());
  const Eigen::MatrixXf& points = encoder_.Forward(lesson.inputs);
  const Eigen::MatrixXf missed = decoder_.Forward(points) - lesson.targets;
  Eigen::MatrixXf point_slope;
  decoder_.Backward(missed / count, gradient.decoder, &point_slope);
  const Eigen::MatrixXf off = points - lesson.points;
  const Eigen::MatrixXf led = off * lesson.led.asDiagonal();
  point_slope += led / count;
  encoder_.Backward(point_slope, gradient.encoder);
  for (vdm::NetGradient* half : {&gradient.encoder, &gradient.decoder}) {
    for (vdm::NetGradient::Layer& layer : half->layers) layer.biases.setZero();
  }
  const double miss = missed.cast<double>().squaredNorm();
  const double way = off.cast<double>().cwiseProduct(led.cast<double>()).sum();
  return (miss + way) / (2 * static_cast<double>(count));
}

}  // namespace facespace
