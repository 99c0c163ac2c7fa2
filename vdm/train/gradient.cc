#include "vdm/train/gradient.h"

#include <algorithm>

namespace vdm {

NetGradient::NetGradient(const TimeDelayNet& net) {
  for (const TimeDelayLayer& layer : net.layers) {
    layers.push_back({Eigen::MatrixXf::Zero(layer.weights.rows(), layer.weights.cols()),
                      Eigen::VectorXf::Zero(layer.biases.size())});
  }
}

void NetGradient::SetZero() {
  for (Layer& layer : layers) {
    layer.weights.setZero();
    layer.biases.setZero();
  }
}

void NetGradient::Add(const NetGradient& other) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    layers[i].weights += other.layers[i].weights;
    layers[i].biases += other.layers[i].biases;
  }
}

void BackPropagation::Disturb(double strength, Dice& dice) {
  for (std::size_t i = 0; i + 1 < steps_.size(); ++i) {
    Eigen::VectorXf& factors = steps_[i].factors;
    factors.resize(net_.layers[i].weights.rows());
    for (float& factor : factors) {
      factor = static_cast<float>(dice.Between(1 - 2 * strength, 1 + 2 * strength));
    }
  }
}

const Eigen::MatrixXf& BackPropagation::Forward(const Eigen::MatrixXf& input) {
  const Eigen::MatrixXf* below = &input;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const TimeDelayLayer& layer = net_.layers[i];
    Step& step = steps_[i];
    Gather(*below, layer.offsets, step.gathered);
    step.outputs.noalias() = layer.weights * step.gathered;
    step.outputs.colwise() += layer.biases;
    if (layer.rectified) step.outputs = step.outputs.cwiseMax(0.0F);
    if (step.factors.size() > 0) step.outputs.array().colwise() *= step.factors.array();
    below = &step.outputs;
  }
  return *below;
}

void BackPropagation::Backward(const Eigen::MatrixXf& slope, NetGradient& gradient,
                               Eigen::MatrixXf* input_slope) {
  Eigen::MatrixXf now = slope, gathered, below;
  for (std::size_t i = steps_.size(); i-- > 0;) {
    const TimeDelayLayer& layer = net_.layers[i];
    const Step& step = steps_[i];
    if (layer.rectified) now = (step.outputs.array() > 0).select(now, 0.0F);
    if (step.factors.size() > 0) now.array().colwise() *= step.factors.array();
    gradient.layers[i].weights.noalias() += now * step.gathered.transpose();
    gradient.layers[i].biases += now.rowwise().sum();
    if (i == 0 && input_slope == nullptr) return;
    gathered.noalias() = layer.weights.transpose() * now;
    // Each column of the layer below was used once for every offset: the slopes come together.
    const auto rows = static_cast<Eigen::Index>(layer.inputs);
    const Eigen::Index columns = now.cols();
    below.setZero(rows, columns);
    for (std::size_t o = 0; o < layer.offsets.size(); ++o) {
      const Eigen::Index offset = layer.offsets[o];
      const Eigen::Index first = std::clamp<Eigen::Index>(-offset, 0, columns);
      const Eigen::Index last = std::clamp<Eigen::Index>(columns - offset, first, columns);
      if (last == first) continue;
      below.middleCols(first + offset, last - first) +=
          gathered.block(static_cast<Eigen::Index>(o) * rows, first, rows, last - first);
    }
    now.swap(below);
  }
  *input_slope = std::move(now);
}

}  // namespace vdm
