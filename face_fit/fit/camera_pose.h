#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/rig/angles.h"

namespace facefit {

/// Depth of the face's plane and of the camera, head's frame, millimetres. The camera is as far
/// away as the renderer's (its kFaceDepth), whose lens of 25 degrees shows a portrait 330 mm high.
inline constexpr float kFaceZ = 50;
inline constexpr float kCameraZ = kFaceZ + 744;

/// Returns the angles, degrees, of a rotation that is the product of rotations about y, x and z, as
/// FaceState::head_rotation.
fsm::Angles AnglesOf(const glm::mat3& turn);

/// How a photo was taken: the head is rotated about its middle in front of a camera as far away as
/// the renderer's, so that a fitted head looks the same there.
struct CameraPose {
  glm::vec3 turn_rad{};  ///< about x, y, z
  float focal = 1;       ///< pixels
  glm::vec2 centre{};    ///< pixel on the camera's axis

  glm::mat3 Rotation() const;
  /// From the head's frame to the camera's, and back: millimetres, same axes where turn_rad is 0.
  glm::vec3 ToCamera(glm::vec3 p) const;
  glm::vec3 FromCamera(glm::vec3 q) const;
  /// Returns the direction from the head to the camera, head's frame, unit.
  glm::vec3 TowardsCamera() const;
  glm::vec2 Project(glm::vec3 q) const;  ///< from the camera's frame to pixels
  /// Returns the place of a pixel at depth z of the camera's frame.
  glm::vec3 Unproject(glm::vec2 pixel, float z) const;
  /// From the head's frame to a pixel, and back to the place at depth `z` of the camera's frame.
  glm::vec2 Pixel(glm::vec3 p) const { return Project(ToCamera(p)); }
  glm::vec3 PlaceAt(glm::vec2 pixel, float z) const { return FromCamera(Unproject(pixel, z)); }
  /// Projects places; the third coordinate is the depth in the camera's frame.
  std::vector<glm::vec3> ToScreen(std::span<const glm::vec3> places) const;
  float PixelsPerMm() const;  ///< at the depth of the face
};

}  // namespace facefit
