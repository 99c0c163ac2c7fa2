#pragma once

#include <string>

#include "fsm/motion/inputs/emotion_space.h"

namespace facespace {

/// Where an expression lies in the space.
struct Whereabouts {
  fsm::EmotionSpace::Point at{};
  std::string emotion;  ///< the one whose direction is nearest; NEUTRAL near the middle
  double strength = 0;  ///< of it: how far out, beside where the emotion lies
  double held = 1;      ///< part of the squares of all units that the space gives back, 0..1
};

/// Nearer to the middle than this the face is at rest.
inline constexpr double kNeutralWithin = 0.2;

/// Both sides count half; units that the space does not have count as not given back.
Whereabouts WhereIs(const fsm::EmotionSpace& space, const fsm::FaceLook& look);

}  // namespace facespace
