#pragma once

#include <utility>
#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/fit/camera_pose.h"
#include "fsm/head/warp.h"
#include "fsm/rig/eye_transform.h"
#include "fsm/rig/face_state.h"

namespace facefit {

/// The expression in the photo: strengths of action units, 0 to 1.5.
struct Expression {
  float smile = 0;      ///< AU 12 with 6
  float jaw_drop = 0;   ///< AU 26
  float lips_part = 0;  ///< AU 25
  fsm::FaceState State() const {
    fsm::FaceState state;
    state.asymmetry = 0;
    for (const auto& [unit, strength] : {std::pair(fsm::kLipCornerPuller, smile),
                                         {fsm::kCheekRaiser, 0.5F * smile},
                                         {fsm::kJawDrop, jaw_drop},
                                         {fsm::kLipsPart, lips_part}}) {
      for (const fsm::Side side : fsm::kSides) state.au[side][unit] = strength;
    }
    return state;
  }
};

/// How much noise of the warp's points is evened out, as for fsm::Warp.
inline constexpr float kWarpSmoothMm = 1;

/// The base head brought into the form, pose and expression of the photo.
struct FittedHead {
  const ObservedHead* base = nullptr;  ///< outlives this
  CameraPose pose;
  Expression expression;
  /// Base head at rest -> person at rest, evened out by kWarpSmoothMm.
  std::vector<fsm::WarpPoint> warp_points;
  fsm::Sided<fsm::EyeTransform> eyes;
  /// Every vertex of the base head in the photo's expression, head's frame.
  std::vector<glm::vec3> base_in_expression;
  /// Every vertex in the person's form, in the photo's expression, head's frame.
  std::vector<glm::vec3> vertices;
  /// Returns the position of a point of the network in the photo's expression, head's frame.
  glm::vec3 PositionOf(PointIndex i) const { return base->mesh_points()[i].On(vertices); }
};

}  // namespace facefit
