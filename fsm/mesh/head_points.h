#pragma once

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/mesh/transfer/deformation_transfer.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Corresponding points of a built-in face and an imported head, as in a file HEAD.points.
struct HeadPoints {
  std::string face = "galatea";  ///< the name of the built-in face
  /// from: on the built-in face, in our frame; to: on the imported head, in its own frame and unit.
  std::vector<PointPair> pairs;
};
/// Parses lines `face NAME` and `point PART X Y Z X Y Z`, where PART is one of plain, upper_lip,
/// lower_lip, upper_lid, lower_lid. Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<HeadPoints> ParseHeadPoints(const std::string& name, std::string_view text);
std::string FormatHeadPoints(const HeadPoints& points);

/// A similarity transformation: rotation, scale and translation.
struct Similarity {
  glm::mat3 rotation{1.0f};
  float scale = 1;
  glm::vec3 translation{0};
  glm::vec3 operator()(glm::vec3 p) const { return scale * (rotation * p) + translation; }
  glm::vec3 Inverse(glm::vec3 p) const {
    return glm::transpose(rotation) * ((p - translation) / scale);
  }
};
/// Returns the transformation from the pairs' `to` to their `from` with the least sum of squared
/// distances. REQUIRES: three pairs or more, not all collinear.
Similarity FitSimilarity(std::span<const PointPair> pairs);

}  // namespace fsm
