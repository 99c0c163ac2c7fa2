#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vdm/net/mouth_net.h"

namespace vdm {

/// The mouth at one instant, as the face takes it: the 17 mouth parameters at full articulation
/// (mm on a mouth 50 mm wide, jaw in degrees; docs/face.md), the sealing of the lips and the height
/// of the tongue's tip, 0 .. 1, and how likely each class of sounds is.
struct MouthFrame {
  std::array<float, kMouthParameters> mouth{};
  float seal = 1;
  float tongue = 0;
  std::vector<float> sounds;  ///< beside MouthNet::sounds; sum 1

  /// About how far the inner lips are apart, in mm at full articulation: what lips and jaw (1.4 mm
  /// a degree) give, unless they are sealed.
  float Opening() const;
};

/// What a column of outputs means. Lips are sealed where the closure is more likely than not, with
/// a short way between, and all of the mouth rests then in what is no sound.
MouthFrame FrameOf(const MouthNet& net, const Eigen::Ref<const Eigen::VectorXf>& outputs);

}  // namespace vdm
