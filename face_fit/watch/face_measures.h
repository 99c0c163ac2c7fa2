#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "face_fit/find/network/attention_points.h"

namespace facefit {

/// What a face in a picture does, in millimetres on a face whose outer corners of the eyes lie
/// kEyesApartMm apart, turned back to how it is held in the first picture. `right` and `left` are
/// the person's.
struct FaceMeasures {
  float certainty = 0;                ///< 0..1 that there is a face
  float gap_mm = 0;                   ///< between the inner edges of the lips, mean of three places
  float width_mm = 0;                 ///< from corner to corner of the lips
  float jaw_mm = 0;                   ///< from below the nose to the chin
  fsm::Sided<float> corner_up_mm{};   ///< corners of the lips above the point below the nose
  fsm::Sided<float> eye_mm{};         ///< between the edges of the lids, mean of three places
  fsm::Sided<float> brow_inner_mm{};  ///< above the line through the corners of both eyes
  fsm::Sided<float> brow_outer_mm{};
  glm::vec3 turn_deg{0};  ///< since the first picture: down, to its left, towards its left shoulder
  glm::vec2 gaze{0};      ///< iris from the middle of the eye, parts of the eye's width:
                          ///< towards the viewer's right, up; mean of both eyes
};

/// The points of a face in millimetres, y up. REQUIRES: all points, the corners of the eyes apart.
std::vector<glm::vec3> PointsInMm(const FoundFace& face);
/// `first`: the points of the first picture in millimetres. REQUIRES: as PointsInMm.
FaceMeasures Measure(const AttentiveFace& found, std::span<const glm::vec3> first);

}  // namespace facefit
