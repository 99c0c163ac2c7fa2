#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/rig/angles.h"

namespace facefit {

/// Where the camera stands, as that of the renderer does: so far before the plane of the face (its
/// kFaceDepth) that a lens of 25 degrees shows a portrait 330 mm high. Millimetres.
inline constexpr float kFaceZ = 50;
inline constexpr float kCameraZ = kFaceZ + 744;

/// Degrees of a turn that is the product of those about y, x and z, as FaceState::head_rotation.
fsm::Angles AnglesOf(const glm::mat3& turn);

/// How the photo was taken: a head turned about its middle before a camera as far away as that of
/// the renderer, so that what is fitted looks the same there.
struct CameraPose {
  glm::vec3 turn_rad{};  ///< about x, y, z
  float focal = 1;       ///< pixels
  glm::vec2 centre{};    ///< pixel on the camera's axis

  glm::mat3 Rotation() const;
  /// From the head's frame to the camera's, and back: millimetres, same axes when turn_rad is 0.
  glm::vec3 ToCamera(glm::vec3 p) const;
  glm::vec3 FromCamera(glm::vec3 q) const;
  /// The direction from which the photo was taken, in the head's frame, unit.
  glm::vec3 TowardsCamera() const;
  glm::vec2 Project(glm::vec3 q) const;                 ///< from the camera's frame to pixels
  glm::vec3 Unproject(glm::vec2 pixel, float z) const;  ///< to the place at that depth
  /// From the head's frame to pixels, and back to the place at depth `z` of the camera's frame.
  glm::vec2 Pixel(glm::vec3 p) const { return Project(ToCamera(p)); }
  glm::vec3 PlaceAt(glm::vec2 pixel, float z) const { return FromCamera(Unproject(pixel, z)); }
  /// Pixels of many places, with their depths in the camera's frame as third coordinates.
  std::vector<glm::vec3> ToScreen(std::span<const glm::vec3> places) const;
  float PixelsPerMm() const;  ///< at the depth of the face
};

}  // namespace facefit
