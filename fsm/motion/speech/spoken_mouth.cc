#include "fsm/motion/speech/spoken_mouth.h"

#include "fsm/motion/motion_settings.h"

namespace fsm {

MouthPose ClosedMouth() {
  MouthPose pose;
  pose.seal = 1;
  pose.contact = 1;
  return pose;
}

void SpokenMouth::BlendOver(const MouthPose& other, double other_share) {
  pose = Mix(pose, other, other_share);
  share = 1 - (1 - share) * (1 - other_share);
}

void SpokenMouth::Contribute(double mouth_scale, std::string_view layer_name,
                             MotionLayers& layers) const {
  const double contact = share * pose.contact;
  layers.AddSignal("lips_taken", share);
  layers.AddSignal("contact", contact);
  MotionLayer& layer = layers.Layer(layer_name);
  double scale = mouth_scale / kFullMouthScale;
  if (scale > 1) scale = 1 + (scale - 1) * (1 - contact);  // a contact is not enlarged
  for (std::size_t i = 0; i < kMouthParameters; ++i) {
    layer.mouth[i] = static_cast<float>(share * scale * pose.mouth[i]);
  }
  layer.seal = static_cast<float>(share * pose.seal);
  layer.tongue = static_cast<float>(share * pose.tongue);
}

}  // namespace fsm
