#pragma once

#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/inputs/viseme_tables.h"

namespace fsm {

/// Returns the mouth with closed lips.
MouthPose ClosedMouth();

/// The mouth of speech at one instant.
struct SpokenMouth {
  double weight = 0;  ///< 0..1; the rest is left to other movements
  MouthPose pose;     ///< at full articulation

  /// Blends `other` over this mouth with the weight `other_weight`, 0..1.
  void BlendOver(const MouthPose& other, double other_weight);
  /// Adds the mouth, scaled by `mouth_scale`, to a layer, and gives the signals `lips_taken` and
  /// `contact`.
  void Contribute(double mouth_scale, std::string_view layer, MotionLayers& layers) const;
};
SpokenMouth Mix(const SpokenMouth& a, const SpokenMouth& b, double share_of_b);

}  // namespace fsm
