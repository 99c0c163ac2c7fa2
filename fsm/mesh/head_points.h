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

/// Places that a built-in face and somebody else's head both have: the file HEAD.points.
struct HeadPoints {
  std::string face = "galatea";  ///< the built-in one
  /// from: on the built-in face, our frame; to: on the other head, its own frame and unit.
  std::vector<PointPair> pairs;
};
/// A table of lines `face NAME` and `point PART X Y Z  X Y Z`, PART one of plain, upper_lip,
/// lower_lip, upper_lid, lower_lid. Errors: kBadValue "NAME:LINE: what was expected".
vm::Result<HeadPoints> ParseHeadPoints(const std::string& name, std::string_view text);
std::string FormatHeadPoints(const HeadPoints& points);

/// Turn, scale and translation.
struct Similarity {
  glm::mat3 turn{1.0f};
  float scale = 1;
  glm::vec3 move{0};
  glm::vec3 operator()(glm::vec3 p) const { return scale * (turn * p) + move; }
  glm::vec3 Inverse(glm::vec3 p) const { return glm::transpose(turn) * ((p - move) / scale); }
};
/// What takes the pairs' `to` nearest to their `from`, by least squares. REQUIRES: three pairs or
/// more, not all in a line.
Similarity FitSimilarity(std::span<const PointPair> pairs);

}  // namespace fsm
