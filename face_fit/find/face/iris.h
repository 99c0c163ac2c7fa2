#pragma once

#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "face_fit/find/face/lid_lines.h"
#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// The edge between an iris and the white, as seen in a photo.
struct IrisCircle {
  glm::vec2 centre;
  float radius = 0;    ///< pixels
  float contrast = 0;  ///< how much brighter the white is, 0..1; below kClearIris nothing was seen
};
inline constexpr float kClearIris = 0.06F;

/// An open eye in a photo, pixels.
struct OpenEye {
  EyePoints lids;
  glm::vec2 middle;           ///< of the iris where eyes look into the camera
  float expected_radius = 0;  ///< by the head's form
};

/// Finds the irises of the eyes given: the circle that best separates dark from bright between the
/// lids, and whose left and right sides have the strongest edge. Irises of one person have one
/// size, so all eyes are searched together. Returns a circle for each eye, in their order.
std::vector<IrisCircle> FindIrises(const fsm::Image& photo, std::span<const OpenEye> eyes);

}  // namespace facefit
