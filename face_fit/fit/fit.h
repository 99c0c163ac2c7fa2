#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/find/face_finder.h"
#include "face_fit/find/iris.h"
#include "face_fit/fit/base_head.h"
#include "fsm/head/warp.h"
#include "fsm/rig/eye_transform.h"

namespace facefit {

/// How the photo was taken: a head turned about its middle before a camera as far away as that of
/// the renderer, so that what is fitted looks the same there.
struct Pose {
  glm::vec3 turn{};  ///< radians about x, y, z
  float focal = 1;   ///< pixels
  glm::vec2 centre;  ///< pixel on the camera's axis

  glm::mat3 Rotation() const;
  /// From the head's frame to the camera's, and back: millimetres, same axes when turn is 0.
  glm::vec3 ToCamera(glm::vec3 p) const;
  glm::vec3 FromCamera(glm::vec3 q) const;
  glm::vec2 Project(glm::vec3 q) const;                 ///< from the camera's frame to pixels
  glm::vec3 Unproject(glm::vec2 pixel, float z) const;  ///< to the place at that depth
  float PixelsPerMm() const;                            ///< at the depth of the face
};

/// What the face in the photo does, 0..1.
struct Expression {
  float smile = 0;   ///< AU 12 with 6
  float jaw = 0;     ///< AU 26
  float parted = 0;  ///< AU 25
  fsm::FaceState State() const;
};

/// Where a place of the head has to be seen in the photo, and how near to the camera it lies.
struct LandmarkConstraint {
  int point;  ///< of the network, -1 = none
  MeshPlace place;
  glm::vec2 pixel;
  float z;  ///< in the camera's frame
};

struct Fit {
  Pose pose;
  Expression expression;
  bool lips_apart = false;
  std::vector<LandmarkConstraint> aims;
  std::vector<fsm::WarpPoint> points;  ///< base face at rest -> person at rest
  float smooth = 1;
  std::array<fsm::EyeTransform, 2> eyes;  ///< right, left
  std::array<IrisRing, 2> irises;         ///< likewise, in the photo
  float iris_size = 1;                    ///< of that of the built-in head, by the size of the eye
  std::vector<glm::vec3> worn;  ///< every vertex of the base as it lies in the photo, head's frame
  float residual_mm = 0;        ///< mean distance of the network's points from those of the fit
};

/// Pose and expression by least squares, then the form. With the photo closed lips are parted where
/// they are seen to meet.
Fit FitFace(const BaseHead& base, const FoundFace& face, const fsm::Image* photo = nullptr);

}  // namespace facefit
