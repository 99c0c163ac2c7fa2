#pragma once

#include <optional>
#include <span>
#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/found_face.h"
#include "face_fit/fit/camera_pose.h"
#include "face_fit/fit/fitted_head.h"
#include "face_fit/fit/photo_irises.h"

namespace facefit {

/// A point of the head that must appear at a pixel of the photo, at a depth.
struct PixelConstraint {
  std::optional<PointIndex> point;  ///< if it is a point of the network
  MeshPoint on_head;
  glm::vec2 pixel;
  float z_mm;  ///< depth in the camera's frame, towards the camera
  bool IsAmong(std::span<const PointIndex> points) const {
    return point && Contains(points, *point);
  }
};

/// A face and the head that is fitted to it. Both must outlive this object.
struct FitProblem {
  FitProblem(const ObservedHead& base_head, const FoundFace& found_face);
  const ObservedHead& base;
  const FoundFace& face;
  /// By point of the network: the depth on the base head less the depth that the network reports
  /// for it, mean 0, millimetres. Added to what it reports of a photo.
  PerPoint<float> depth_bias;
  bool lips_apart;
};

/// Returns for each of point::kReliable how much nearer to the camera the network sees it than the
/// base head has it, mean 0, millimetres. `base_in_expression`: as FittedHead's.
std::vector<float> NetworkDepthGapsMm(const FitProblem& problem, const CameraPose& pose,
                                      std::span<const glm::vec3> base_in_expression);

/// Returns the constraints of the warp for a pose: the network's points, whose
/// depth is mostly the head's own. Eyes whose irises the photo shows elsewhere are moved up or down
/// with them. Closed lips meet where the photo shows the lip seam; for the inner lips of
/// an open mouth there are none, because at rest both are one line, which cannot be moved to two
/// separate ones. `base_in_expression`: as FittedHead's.
std::vector<PixelConstraint> MakeConstraints(const FitProblem& problem, const CameraPose& pose,
                                             std::span<const glm::vec3> base_in_expression,
                                             const PhotoIrises& irises, const fsm::Image& photo);

}  // namespace facefit
