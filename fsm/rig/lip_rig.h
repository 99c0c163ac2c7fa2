#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "fsm/base/side.h"

namespace fsm {

/// Vertices of the two middle incisors of each jaw.
struct Incisors {
  std::uint32_t upper = 0, lower = 0;  ///< at the incisal edges
  std::uint32_t upper_root = 0;        ///< directly above `upper`
};

/// The vertices of a mouth that the rig keeps the lips together by, measures the mouth by, and by
/// which the renderer finds the light that enters it.
struct MouthVertices {
  using SeamPair = std::pair<std::uint32_t, std::uint32_t>;
  /// Pairs of upper and lower lip vertices that meet when the mouth is closed, from -x to +x, with
  /// the median in the middle; may be empty.
  std::vector<SeamPair> seam;
  std::optional<Sided<std::uint32_t>> corners;  ///< none: the mouth cannot be measured
  std::optional<Incisors> incisors;  ///< none: no teeth are lit by what enters between the lips

  /// REQUIRES: `seam` is not empty.
  const SeamPair& Middle() const { return seam[seam.size() / 2]; }
};

/// Lips that must not cross, and must not stay open when they are sealed.
struct LipRig {
  /// For each pair of MouthVertices::seam the offset from lower to upper vertex in a closed mouth,
  /// millimetres; empty: 0.
  std::vector<glm::vec3> apart_at_rest;
  glm::vec3 ApartAtRest(std::size_t pair) const {
    return apart_at_rest.empty() ? glm::vec3(0) : apart_at_rest[pair];
  }
  struct Follower {
    std::uint32_t vertex;
    std::uint32_t pair;  ///< index into MouthVertices::seam: the pair whose gap moves it
    float hold;          ///< -1..1: > 0 on the upper lip, < 0 on the lower
  };
  /// Returns the signed fraction of its pair's gap by which a follower moves.
  static float ShareOf(const Follower& f) {
    constexpr float kUpperShare = 0.4f;  // the upper lip's share of the way to each other
    return (f.hold > 0 ? kUpperShare : 1 - kUpperShare) * f.hold;
  }
  std::vector<Follower> followers;
};

}  // namespace fsm
