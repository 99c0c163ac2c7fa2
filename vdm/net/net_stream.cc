#include "vdm/net/net_stream.h"

#include <algorithm>

namespace vdm {

NetStream::NetStream(const TimeDelayNet& net) : net_(net) {
  for (const TimeDelayLayer& layer : net.layers) {
    const int span = std::max(layer.offsets.back(), 0) - std::min(layer.offsets.front(), 0) + 1;
    const auto rows = static_cast<Eigen::Index>(layer.inputs);
    stages_.push_back({.ring = Eigen::MatrixXf::Zero(rows, span),
                       .gathered = Eigen::VectorXf(layer.weights.cols())});
  }
}

const Eigen::VectorXf& NetStream::Add(const Eigen::VectorXf& vector) {
  now_ = vector;
  for (std::size_t i = 0; i < stages_.size(); ++i) {
    const TimeDelayLayer& layer = net_.layers[i];
    Stage& stage = stages_[i];
    const Eigen::Index span = stage.ring.cols();
    stage.ring.col(stage.count % span) = now_;
    const Eigen::Index at = stage.count++ - std::max(layer.offsets.back(), 0);
    if (at < 0) {
      now_.resize(0);
      return now_;
    }
    for (std::size_t o = 0; o < layer.offsets.size(); ++o) {
      auto part = stage.gathered.segment(static_cast<Eigen::Index>(o) * stage.ring.rows(),
                                         stage.ring.rows());
      const Eigen::Index from = at + layer.offsets[o];
      if (from < 0) {
        part.setZero();
      } else {
        part = stage.ring.col(from % span);
      }
    }
    now_.noalias() = layer.weights * stage.gathered;
    now_ += layer.biases;
    if (layer.rectified) now_ = now_.cwiseMax(0.0F);
  }
  return now_;
}

}  // namespace vdm
