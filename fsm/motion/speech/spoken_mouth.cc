#include "fsm/motion/speech/spoken_mouth.h"

#include <cmath>

#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/inputs/motion_settings.h"

namespace fsm {

MouthPose ClosedMouth() {
  MouthPose pose;
  pose.seal = 1;
  pose.contact = 1;
  return pose;
}

void SpokenMouth::BlendOver(const MouthPose& other, double other_weight) {
  *this = Mix(*this, {1, other}, other_weight);
}

SpokenMouth Mix(const SpokenMouth& a, const SpokenMouth& b, double share_of_b) {
  return {std::lerp(a.weight, b.weight, share_of_b), Mix(a.pose, b.pose, share_of_b)};
}

void SpokenMouth::Contribute(double mouth_scale, std::string_view layer_name,
                             MotionLayers& layers) const {
  const double contact = weight * pose.contact;
  layers.AddSignal(SignalName::kLipsTaken, weight);
  layers.AddSignal(SignalName::kContact, contact);
  MotionLayer& layer = layers.Layer(layer_name);
  double scale = mouth_scale / kFullMouthScale;
  if (scale > 1) scale = 1 + (scale - 1) * (1 - contact);  // a contact is not enlarged
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    layer.mouth[i] = static_cast<float>(weight * scale * pose.mouth[i]);
  }
  layer.seal = static_cast<float>(weight * pose.seal);
  layer.tongue = static_cast<float>(weight * pose.tongue);
}

}  // namespace fsm
