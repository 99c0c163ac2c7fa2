#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fsm {

/// A point of the base head and where it goes.
struct WarpPoint {
  glm::vec3 at, by;
};

/// A displacement of space that takes points nearly where they should go and everything else
/// smoothly along: radial functions phi(r) = r and an affine part.
class Warp {
 public:
  Warp() = default;
  /// `smooth`: millimetres by which noise of the points is evened out, 0 = exactly through them.
  /// Throws std::runtime_error if the points lie in a plane or are fewer than four.
  Warp(std::span<const WarpPoint> points, float smooth);
  glm::vec3 Motion(glm::vec3 p) const;

 private:
  std::vector<glm::vec3> at_, weight_;
  std::array<glm::vec3, 4> affine_{};  // constant, then for x, y and z
};

}  // namespace fsm
