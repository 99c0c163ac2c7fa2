#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace facefit {

// Frames. Both are right-handed, in millimetres; frames and pixels are said at every function.
//
//   head's frame     as of fsm::HeadVertices at rest: x to the person's left, which is the viewer's
//                    right, y up, z forward out of the face; the origin is midway between the ears
//   camera's frame   the head's frame where rotation_rad is 0; otherwise the head is rotated in it
//                    about (0, -10, 20). The camera stands at (0, 0, kCameraDepthMm) and looks
//                    along -z, so that a greater z is nearer to it: z is the depth towards the
//                    camera
//   pixel            x to the right, y down, the centre of the first at (0.5, 0.5)

/// Depth of the face's plane and of the camera, camera's frame. The camera is as far away as the
/// renderer's (its kFaceDepth), whose lens of 14 degrees shows a portrait 330 mm high.
inline constexpr float kFaceDepthMm = 50;
inline constexpr float kCameraDepthMm = kFaceDepthMm + 1344;
/// Approximate depth of what lies beside the face, camera's frame, millimetres: accurate enough to
/// tell which part of the head a pixel covers.
inline constexpr float kBesideFaceDepthMm = 20;

/// How a photo was taken: the head is rotated in front of a camera as far away as the renderer's,
/// so that a fitted head looks the same there.
struct CameraPose {
  /// Right-handed about the fixed axes of the camera's frame. Positive x bends the face down, y
  /// turns it to the person's left, z tilts the head to its right, counter-clockwise for the
  /// viewer.
  glm::vec3 rotation_rad{};
  float focal_px = 1;
  glm::vec2 centre_px{};  ///< on the camera's axis

  /// From the head's axes to the camera's: first about y, then x, then z, so z * x * y as matrices.
  glm::mat3 Rotation() const;
  /// From the head's frame to the camera's, and back.
  glm::vec3 ToCamera(glm::vec3 p) const;
  std::vector<glm::vec3> ToCamera(std::span<const glm::vec3> positions) const;
  glm::vec3 FromCamera(glm::vec3 q) const;
  /// Returns the direction from the head to the camera, head's frame, unit.
  glm::vec3 TowardsCamera() const;
  glm::vec2 Project(glm::vec3 q) const;  ///< from the camera's frame to pixels
  /// From a pixel to the position at depth `z`, camera's frame.
  glm::vec3 Unproject(glm::vec2 pixel, float z) const;
  /// From the head's frame to a pixel, and back to the position at depth `camera_z` of the camera's
  /// frame.
  glm::vec2 PixelOf(glm::vec3 p) const { return Project(ToCamera(p)); }
  glm::vec3 PositionOf(glm::vec2 pixel, float camera_z) const {
    return FromCamera(Unproject(pixel, camera_z));
  }
  /// From the head's frame to pixels; the third coordinate is the depth in the camera's frame.
  std::vector<glm::vec3> ToScreen(std::span<const glm::vec3> positions) const;
  float PixelsPerMm() const;  ///< at the depth of the face
};

}  // namespace facefit
