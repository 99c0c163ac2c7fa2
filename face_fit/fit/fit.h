#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/find/face/iris.h"
#include "face_fit/find/head/base_head.h"
#include "face_fit/find/network/face_finder.h"
#include "fsm/head/warp.h"
#include "fsm/rig/eye_transform.h"

namespace facefit {

/// The renderer's camera stands 744 mm before the plane z = 50 (a portrait 330 mm high through a
/// lens of 25 degrees).
inline constexpr float kCameraZ = 794;

/// How the photo was taken: a head turned about its middle before a camera as far away as that of
/// the renderer, so that what is fitted looks the same there.
struct CameraPose {
  glm::vec3 turn{};  ///< radians about x, y, z
  float focal = 1;   ///< pixels
  glm::vec2 centre;  ///< pixel on the camera's axis

  glm::mat3 Rotation() const;
  /// From the head's frame to the camera's, and back: millimetres, same axes when turn is 0.
  glm::vec3 ToCamera(glm::vec3 p) const;
  glm::vec3 FromCamera(glm::vec3 q) const;
  /// The direction from which the photo was taken, in the head's frame, unit.
  glm::vec3 TowardsCamera() const;
  glm::vec2 Project(glm::vec3 q) const;                 ///< from the camera's frame to pixels
  glm::vec3 Unproject(glm::vec2 pixel, float z) const;  ///< to the place at that depth
  float PixelsPerMm() const;                            ///< at the depth of the face
};

/// What the face in the photo does: strengths of action units, 0 to 1.5.
struct Expression {
  float smile = 0;   ///< AU 12 with 6
  float jaw = 0;     ///< AU 26
  float parted = 0;  ///< AU 25
  fsm::FaceState State() const;
};

/// A point of the head, where the photo shows it, and its depth.
struct LandmarkConstraint {
  PointIndex point;  ///< of the network, or kNoPoint
  MeshPoint on_head;
  glm::vec2 pixel;
  float z;  ///< in the camera's frame, millimetres towards it
};

struct Fit {
  CameraPose pose;
  Expression expression;
  bool lips_apart = false;
  std::vector<LandmarkConstraint> constraints;
  std::vector<fsm::WarpPoint> points;  ///< base face at rest -> person at rest
  float smooth = 1;
  fsm::Sided<fsm::EyeTransform> eyes;
  fsm::Sided<IrisRing> irises;  ///< in the photo
  float iris_size = 1;          ///< of that of the built-in head, by the size of the eye
  std::vector<glm::vec3>
      posed_vertices;     ///< every vertex of the base as it lies in the photo, head's frame
  float residual_mm = 0;  ///< mean distance of the network's points from those of the fit
};

/// Fits the base head to the points of a face: pose and expression by least squares, then the form
/// by a warp. `photo`, if given, shows the irises and the line where closed lips meet, which the
/// points miss by some pixels. Pure; thread: any. REQUIRES: face.points has kNetworkPoints.
Fit FitFace(const BaseHead& base, const FoundFace& face, const fsm::Image* photo = nullptr);

}  // namespace facefit
