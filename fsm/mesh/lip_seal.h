#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/mesh/mesh_model.h"

namespace fsm {

/// Keeps the lips of a mesh from crossing, and closes them on demand.
class LipSeal {
 public:
  /// Knows the lips by model.seam; without it Close does nothing. The first `count` vertices are
  /// considered.
  LipSeal(const MeshModel& model, std::size_t count);
  /// `seal`: 0 = only what has crossed is pushed back, 1 = the lips meet.
  void Close(float seal, std::span<glm::vec3> position) const;

 private:
  struct Follower {
    std::uint32_t vertex;
    std::uint32_t pair;
    float part;  // > 0 of the upper lip, < 0 of the lower
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam_;
  std::vector<glm::vec3> apart_at_rest_;
  std::vector<Follower> followers_;
};

}  // namespace fsm
