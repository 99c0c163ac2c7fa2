#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "fsm/rig/face_state.h"
#include "fsm/rig/rig_data.h"
#include "fsm/rig/unit_combiner.h"
#include "fsm/rig/unit_effects.h"

namespace fsm {

/// Motion of the mandible: rotation about the hinge, slide forward, sway to the viewer's right.
struct JawMove {
  float open_rad = 0, slide_mm = 0, sway_mm = 0;
};

/// The values computed from one state that determine every vertex.
struct Pose {
  Sided<UnitValues> au;
  std::array<float, kMouthParameters> mouth;  ///< those of the jaw without what action units add
  Sided<float> blink;                         ///< lid closure beyond that of the action units, 0..1
  Sided<UnitEffects::Lids> lids;              ///< with gaze and blink included
  JawMove jaw;
  float seal = 0;
  float tongue_raise = 0, tongue_out_mm = 0;
  Sided<glm::mat3> eye;
  glm::mat3 head;
  float head_forward_mm = 0;
};
/// Clamps `value` to min..max; a value that is not finite becomes 0.
float Bound(float value, float min, float max);
/// The head's rotation about kNeckPivot, and how far the neck carries it forward, millimetres.
glm::mat3 HeadRotation(const FaceState& state);
float HeadForward(const FaceState& state);
/// Makes the pose of `state`, clamped to what anatomy allows; a value that is not finite becomes 0.
Pose MakePose(const FaceState& state, const UnitTable& units, const UnitCombiner& combiner);

/// GazeOf returns the gaze angles of an eye's rotation; EyeRotationOf is its inverse.
EyeAngles GazeOf(const glm::mat3& eye);
glm::mat3 EyeRotationOf(const EyeAngles& gaze);

}  // namespace fsm
