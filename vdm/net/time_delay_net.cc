#include "vdm/net/time_delay_net.h"

#include <algorithm>

namespace vdm {

std::size_t TimeDelayNet::ahead() const {
  int sum = 0;
  for (const TimeDelayLayer& layer : layers) sum += std::max(layer.offsets.back(), 0);
  return static_cast<std::size_t>(sum);
}

std::size_t TimeDelayNet::behind() const {
  int sum = 0;
  for (const TimeDelayLayer& layer : layers) sum += std::max(-layer.offsets.front(), 0);
  return static_cast<std::size_t>(sum);
}

std::size_t TimeDelayNet::parameters() const {
  Eigen::Index sum = 0;
  for (const TimeDelayLayer& layer : layers) sum += layer.weights.size() + layer.biases.size();
  return static_cast<std::size_t>(sum);
}

Eigen::MatrixXf TimeDelayNet::Outputs(const Eigen::MatrixXf& input) const {
  Eigen::MatrixXf now = input, gathered;
  for (const TimeDelayLayer& layer : layers) {
    Gather(now, layer.offsets, gathered);
    now.noalias() = layer.weights * gathered;
    now.colwise() += layer.biases;
    if (layer.rectified) now = now.cwiseMax(0.0F);
  }
  return now;
}

void Gather(const Eigen::MatrixXf& input, const std::vector<int>& offsets, Eigen::MatrixXf& out) {
  const Eigen::Index rows = input.rows(), columns = input.cols();
  out.resize(rows * static_cast<Eigen::Index>(offsets.size()), columns);
  if (columns == 0) return;  // nothing is allocated then
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    auto block = out.middleRows(static_cast<Eigen::Index>(i) * rows, rows);
    const Eigen::Index offset = offsets[i];
    const Eigen::Index first = std::clamp<Eigen::Index>(-offset, 0, columns);
    const Eigen::Index last = std::clamp<Eigen::Index>(columns - offset, first, columns);
    block.leftCols(first).setZero();
    if (last > first) {
      block.middleCols(first, last - first) = input.middleCols(first + offset, last - first);
    }
    block.rightCols(columns - last).setZero();
  }
}

}  // namespace vdm
