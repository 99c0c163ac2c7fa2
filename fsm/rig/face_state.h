#pragma once

#include <array>
#include <cstddef>

#include "fsm/base/side.h"
#include "fsm/rig/angles.h"
#include "fsm/rig/unit_values.h"

namespace fsm {

/// The parameters of the mouth, in the order of the original's editor and of our tables
/// (docs/face.md). Y points up, Z forward, X outward (for the mouth corners). Units: degrees of
/// opening for kJawY; for all others millimetres on a mouth that is 50 mm wide.
enum MouthParameter : std::size_t {
  kUpperOuterY,
  kUpperOuterZ,
  kUpperInnerY,
  kUpperInnerZ,
  kLowerInnerY,
  kLowerInnerZ,
  kLowerOuterY,
  kLowerOuterZ,
  kCornerX,
  kCornerY,
  kCornerZ,
  kJawY,
  kJawZ,
  kUpperOuterFullness,
  kUpperInnerFullness,
  kLowerOuterFullness,
  kLowerInnerFullness
};
inline constexpr std::size_t kMouthParameters = kLowerInnerFullness + 1;

/// How the whole figure is placed before the camera. It does not affect the vertices of the head.
struct Figure {
  Angles rotation{};
  std::array<float, 2> translation{};  ///< right and up: millimetres, or halves of the view
  float scale = 1;
  float alpha = 1;  ///< opacity
  bool enabled = true;
};

/// Strengths of what action units cannot show of the original's whole expressions
/// (mesh/original/original_expressions.h), 0..2; only heads of the original show them.
using Residuals = std::array<float, 6>;

/// Everything that decides how the face looks, at one instant. A plain value: motion makes it,
/// the head turns it into vertices, the renderer draws them. Frame: x to the viewer's right (so the
/// agent's LEFT side is at +x), y up, z to the viewer; millimetres.
struct FaceState {
  /// Strengths of the action units by FACS number: 0 = rest, 1 = full strength, up to 2 (the
  /// original's 200 %). Emotions arrive here as sums of their action units.
  Sided<UnitValues> au;
  Residuals residuals{};

  /// Mouth parameters in the order of MouthParameter; they may be negative.
  std::array<float, kMouthParameters> mouth{};
  /// The part of `mouth` that was set parameter by parameter (slots Mouth.N). The rest is speech,
  /// for which faces of the original have blend shapes of their own.
  std::array<float, kMouthParameters> mouth_by_hand{};
  /// 0 = the lips follow the parameters; 1 = they are sealed whatever else acts on them (p, b, m,
  /// rest).
  float seal = 0;
  /// Height of the tongue's tip: 0 = low, 1 = on the alveolar ridge behind the upper teeth.
  float tongue = 0;

  Sided<EyeAngles> gaze;
  /// How far each eye's lids close beyond what the action units ask for, 0..1 (blinks).
  Sided<float> blink;

  Angles head_rotation{};  ///< about the neck
  /// How far the neck carries the head forward (+, chin first) or back (-).
  float head_forward_mm = 0;
  /// How much of this head's asymmetry is shown: 0 = both sides move alike, 1 = as the head was
  /// made (MakeHead).
  float asymmetry = 1;
  Figure figure;
};

/// Measurements of the mouth in one state, for tests, reports and lip-sync checks.
struct MouthMeasure {
  float gap_mm = 0;       ///< between the inner lips at the midline; 0 = closed
  float width_mm = 0;     ///< between the corners
  float jaw_degrees = 0;  ///< rotation about the hinge
};

}  // namespace fsm
