#pragma once

#include "vdm/net/mouth_net.h"

namespace vdm {

/// A small network with weights by formula; nothing is learned in it.
inline MouthNet MadeNet(FeatureKind kind = FeatureKind::kMel) {
  MouthNet net;
  net.features = kind;
  net.sounds = {"sil", "aa"};
  net.scales.fill(1.5F);
  net.means[11] = 2;
  const auto layer = [](std::size_t inputs, std::vector<int> offsets, std::size_t outputs,
                        bool rectified) {
    TimeDelayLayer made;
    made.inputs = inputs;
    made.offsets = std::move(offsets);
    made.rectified = rectified;
    made.weights.resize(static_cast<Eigen::Index>(outputs),
                        static_cast<Eigen::Index>(inputs * made.offsets.size()));
    for (Eigen::Index i = 0; i < made.weights.size(); ++i) {
      made.weights.data()[i] = 0.3F * std::sin(1.7F * static_cast<float>(i));
    }
    made.biases = Eigen::VectorXf::LinSpaced(static_cast<Eigen::Index>(outputs), -0.2F, 0.3F);
    return made;
  };
  const std::size_t inputs = MakeFeatures(kind)->size();
  net.net.layers = {layer(inputs, {-2, 0, 1}, 7, true), layer(7, {-3, 2}, 5, true),
                    layer(5, {0}, net.first_sound_row() + 2, false)};
  return net;
}

}  // namespace vdm
