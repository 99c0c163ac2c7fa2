#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace fsm {

/// Lips that must not cross, and must not stay open when they are sealed.
struct LipRig {
  /// Pairs of upper and lower lip vertices that meet when the mouth is closed, from -x to +x.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;
  /// For each pair the offset from lower to upper vertex in a closed mouth, millimetres; empty: 0.
  std::vector<glm::vec3> apart_at_rest;
  glm::vec3 ApartAtRest(std::size_t pair) const {
    return apart_at_rest.empty() ? glm::vec3(0) : apart_at_rest[pair];
  }
  struct Follower {
    std::uint32_t vertex;
    std::uint32_t pair;  ///< index into `seam`: the pair whose gap moves it
    float part;          ///< -1..1: > 0 on the upper lip, < 0 on the lower
  };
  /// Returns the signed fraction of its pair's gap by which a follower moves.
  static float ShareOf(const Follower& f) {
    constexpr float kUpperShare = 0.4f;  // the upper lip's share of the way to each other
    return (f.part > 0 ? kUpperShare : 1 - kUpperShare) * f.part;
  }
  std::vector<Follower> followers;
  /// The vertices that measure the mouth: both lips at the midline, and the agent's mouth corners.
  enum Measured : std::size_t { kUpperLip, kLowerLip, kCornerLeft, kCornerRight };
  std::optional<std::array<std::uint32_t, 4>> measured;
};

}  // namespace fsm
