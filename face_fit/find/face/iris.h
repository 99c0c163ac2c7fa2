#pragma once

#include <glm/vec2.hpp>

#include "face_fit/find/face/lid_lines.h"

namespace facefit {

/// The edge between an iris and the white, as seen in a photo.
struct IrisCircle {
  glm::vec2 centre_px;
  float radius_px = 0;
  /// Contrast of the edge, -1.35..1.35: the lesser step of brightness of both sides + 0.35 times
  /// the greater one. Below kClearIris no iris was seen.
  float contrast = 0;
};
inline constexpr float kClearIris = 0.06F;

/// Where a photo is expected to show an eye, pixels.
struct ExpectedEye {
  EyePoints lids;
  glm::vec2 iris_centre_px;  ///< if the eye looks into the camera
  float iris_radius_px = 0;  ///< by the form of the head
  float pixels_per_mm = 1;   ///< of the head there
};

/// Finds the irises of a person's eyes: for each the circle that best separates dark from bright
/// between the lids and has the strongest edges on its left and right. Both eyes share one relative
/// size.
fsm::Sided<IrisCircle> FindIrises(const fsm::Image& photo, const fsm::Sided<ExpectedEye>& eyes);

}  // namespace facefit
