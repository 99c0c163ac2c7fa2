#pragma once

#include <array>
#include <cstddef>

#include "fsm/rig/unit_values.h"

namespace fsm {

inline constexpr std::size_t kMouthParameters = 17;

/// Everything that decides how the face looks, at one instant. A plain value: motion makes it,
/// the head turns it into vertices, the renderer draws them. Frame: x to the viewer's right (so the
/// agent's LEFT side is at +x), y up, z to the viewer; millimetres and degrees.
struct FaceState {
  /// Action units by FACS number, the agent's left and right side; 0 = rest, 1 = full strength,
  /// up to 2 (the original's 200 %). Emotions arrive here as sums of their AUs.
  UnitValues au_left;
  UnitValues au_right;

  /// Speech, in the 17 mouth parameters of the original editor (docs/face.md), 1-based
  /// there, 0-based here; 1 = the parameter's unit displacement (see the mouth shape table), may be
  /// negative. 0-3 upper lip outer Y, outer Z, inner Y, inner Z; 4-7 lower lip inner Y, inner Z,
  /// outer Y, outer Z; 8-10 corner X, Y, Z; 11-12 jaw Y, Z; 13-16 outer and inner adjust of the
  /// upper and of the lower lip. Units: millimetres on a 50 mm mouth, jaw Y in degrees of opening.
  std::array<float, kMouthParameters> mouth{};
  /// What of `mouth` was asked for parameter by parameter (Mouth.N), the rest being speech: faces
  /// of the original have shapes of their own for it.
  std::array<float, kMouthParameters> mouth_by_hand{};
  /// 0 = lips follow the parameters, 1 = lips are sealed whatever else acts on them (p, b, m,
  /// rest).
  float lip_seal = 0;
  /// Tongue tip height, 0 = low, 1 = on the ridge behind the upper teeth.
  float tongue = 0;

  /// Eye directions in degrees: x = up positive, y = to the viewer's right positive.
  struct Eye {
    float x = 0;
    float y = 0;
  };
  Eye eye_left, eye_right;
  /// Closing of each eye's lids beyond what the AUs ask, 0..1 (blinks).
  float blink_left = 0;
  float blink_right = 0;

  /// Head turn in degrees about the neck. x+ = down (nod), y+ = to the viewer's right, z+ = tilt
  /// towards the viewer's right. The original's axes and signs.
  std::array<float, 3> head_rotation{};
  /// How far the neck carries the head forward (+, chin first) or back, in millimetres.
  float head_forward = 0;
  /// How much of what makes the two sides of this head unlike is shown: 0 = both move alike, 1 = as
  /// the head is (MakeHead).
  float asymmetry = 1;
  /// The whole figure.
  std::array<float, 3> agent_rotation{};
  std::array<float, 2> agent_translation{};
  float agent_scale = 1;
  float agent_alpha = 1;
  bool agent_enabled = true;
};

/// What can be measured of the mouth in a state: for tests, reports and lip-sync checks.
struct MouthMeasure {
  float gap_mm = 0;       ///< between the inner lips at the midline; 0 = closed
  float width_mm = 0;     ///< between the corners
  float jaw_degrees = 0;  ///< opening about the hinge
};

}  // namespace fsm
