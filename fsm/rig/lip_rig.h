#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace fsm {

/// Lips that neither cross nor stay open when they are sealed.
struct LipRig {
  /// Vertices of the upper and the lower lip that meet when the mouth is closed, from -x to +x.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;
  /// How far the two of each pair lie apart in a closed mouth, millimetres; or none at all.
  std::vector<glm::vec3> apart_at_rest;
  glm::vec3 ApartAtRest(std::size_t pair) const {
    return apart_at_rest.empty() ? glm::vec3(0) : apart_at_rest[pair];
  }
  struct Follower {
    std::uint32_t vertex;
    std::uint32_t pair;  ///< index into `seam`: the one that moves it
    float part;          ///< -1..1: > 0 of the upper lip, < 0 of the lower
  };
  /// The part of its pair's gap that a follower moves by.
  static float ShareOf(const Follower& f) {
    constexpr float kUpperShare = 0.4f;  // of the way to each other
    return (f.part > 0 ? kUpperShare : 1 - kUpperShare) * f.part;
  }
  std::vector<Follower> followers;
  /// Vertices that measure the mouth: the lips in the middle, and the agent's corners.
  enum Measured : std::size_t { kUpperLip, kLowerLip, kCornerLeft, kCornerRight };
  std::optional<std::array<std::uint32_t, 4>> measured;
};

}  // namespace fsm
