#pragma once

#include "fsm/motion/motion_source.h"
#include "fsm/motion/viseme_tables.h"

namespace fsm {

/// Lips that rest on each other.
MouthPose ClosedMouth();

/// How long another MouthScale takes to come about.
inline constexpr vm::Time kMouthScaleMove{100'000};

/// The mouth that speech asks for at one instant.
struct SpokenMouth {
  double share = 0;  ///< of the mouth, 0..1; the rest is left to other movements
  MouthPose pose;    ///< at full articulation

  /// Lets another mouth come over it by `other_share`, 0..1.
  void Cover(const MouthPose& other, double other_share);
  /// Puts it on a layer, in the size of that MouthScale, and gives `lips_taken` and `contact`.
  void Contribute(double mouth_scale, std::string_view layer, MotionLayers& layers) const;
};

}  // namespace fsm
