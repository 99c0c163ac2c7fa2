#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "fsm/rig/face_state.h"
#include "fsm/rig/rig_data.h"

namespace fsm {

/// What the lower jaw does: about the hinge, forward and to the viewer's right.
struct JawMove {
  float open_rad = 0, slide_mm = 0, sway_mm = 0;
};

/// The numbers of one state from which every vertex follows.
struct Pose {
  Sided<UnitValues> units;
  std::array<float, kMouthParameters> mouth;  ///< the jaw's without what units move it by
  Sided<float> blink;                         ///< lids close by it beyond the units
  Sided<UnitEffects::Lids> lids;              ///< gaze and blink included
  JawMove jaw;
  float seal = 0;
  float tongue_raise = 0, tongue_out_mm = 0;
  Sided<glm::mat3> eye;
  glm::mat3 head;
  float head_forward_mm = 0;
};
/// `value` within limits; what is no number counts as 0.
float Bound(float value, float least, float most);
/// How the head turns about kNeckPivot, and how far the neck carries it forward, millimetres.
glm::mat3 HeadTurn(const FaceState& state);
float HeadForward(const FaceState& state);
/// Clamps `state` to what anatomy allows; anything not a number counts as 0.
Pose MakePose(const FaceState& state, const UnitTable& units);

/// The gaze of an eye with this rotation, and the rotation for a gaze.
EyeAngles GazeOf(const glm::mat3& eye);
glm::mat3 EyeTo(const EyeAngles& gaze);

}  // namespace fsm
