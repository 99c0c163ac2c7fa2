#pragma once

#include <optional>
#include <span>
#include <vector>

#include "face_fit/find/face/iris.h"
#include "face_fit/find/head/observed_head.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/fit/camera_pose.h"
#include "face_fit/fit/fitted_head.h"

namespace facefit {

/// A point of the head, where the photo shows it, and its depth.
struct LandmarkConstraint {
  std::optional<PointIndex> point;  ///< of the network, if it is one
  MeshPoint on_head;
  glm::vec2 pixel;
  float z_mm;  ///< in the camera's frame, towards it
  bool IsAmong(std::span<const PointIndex> points) const {
    return point && Contains(points, *point);
  }
};

/// What the photo says of the form of the head.
struct PhotoTargets {
  std::vector<LandmarkConstraint> constraints;
  bool lips_apart = false;
};

/// The irises in the photo.
struct PhotoIrises {
  fsm::Sided<IrisCircle> circles;
  float size = 1;  ///< iris radius relative to the built-in head's, after scaling by the eye's size
};
/// Without a photo irises lie where the eyes' outlines say, with a contrast of 0.
PhotoIrises FindPhotoIrises(const ObservedHead& base, const FoundFace& face,
                            const fsm::Image* photo);

/// A face that a head is fitted to. Both outlive this.
struct FitProblem {
  FitProblem(const ObservedHead& base_head, const FoundFace& found_face);
  const ObservedHead& base;
  const FoundFace& face;
  /// What the network sees of depth too little on the base head; mean 0, millimetres.
  std::vector<float> depth_bias;
  bool lips_apart;
};

/// The targets of the warp, for a pose and an expression that are found: the network's points,
/// their depth mostly as the head's own form has it. Eyes whose irises lie elsewhere are moved up
/// or down with them. Closed lips meet where the photo, if there is one, shows the dark line
/// between them.
PhotoTargets TargetsOf(const FitProblem& problem, const CameraPose& pose,
                       const Expression& expression, const PhotoIrises& irises,
                       const fsm::Image* photo);

}  // namespace facefit
