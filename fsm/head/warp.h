#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fsm {

/// A point of the base head and its displacement.
struct WarpPoint {
  glm::vec3 position, displacement;
};

/// A displacement field that moves given points almost to their targets and all others smoothly:
/// radial basis functions phi(r) = r and an affine part.
class Warp {
 public:
  Warp() = default;
  /// `smooth`: millimetres of noise of the points that are evened out, 0 = exact interpolation.
  /// Throws std::runtime_error if the points lie in a plane or are fewer than four.
  Warp(std::span<const WarpPoint> points, float smooth);
  glm::vec3 Motion(glm::vec3 p) const;

 private:
  std::vector<glm::vec3> centres_, weights_;
  std::array<glm::vec3, 4> affine_{};  // constant term, then those of x, y and z
};

}  // namespace fsm
