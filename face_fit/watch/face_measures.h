#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "face_fit/find/network/attention_points.h"

namespace facefit {

/// Measurements of a face in a frame: millimetres on a face whose outer corners of the eyes lie
/// kEyesApartMm apart, rotated back to the pose of the first frame. `right` and `left` are the
/// person's.
struct FaceMeasures {
  float certainty = 0;                ///< confidence, 0..1, that there is a face
  float gap_mm = 0;                   ///< between the inner edges of the lips, mean of three pairs
  float width_mm = 0;                 ///< from corner to corner of the lips
  float jaw_mm = 0;                   ///< from below the nose to the chin
  fsm::Sided<float> corner_up_mm{};   ///< corners of the lips above the point below the nose
  fsm::Sided<float> eye_mm{};         ///< between the edges of the lids, mean of three pairs
  fsm::Sided<float> brow_inner_mm{};  ///< above the line through the corners of both eyes
  fsm::Sided<float> brow_outer_mm{};
  /// Since the first frame: down, to the person's left, towards the left shoulder.
  glm::vec3 turn_deg{0};
  /// Offset of the iris from the middle of the eye, divided by the eye's width: to the viewer's
  /// right, up; mean of both eyes.
  glm::vec2 gaze{0};
};

/// Returns the points of a face in millimetres, y up. REQUIRES: all points; the outer corners of
/// the eyes do not coincide.
std::vector<glm::vec3> PointsInMm(const FoundFace& face);
/// Measures a face. `first`: PointsInMm of the first frame. REQUIRES: as PointsInMm.
FaceMeasures Measure(const AttentiveFace& found, std::span<const glm::vec3> first);

}  // namespace facefit
