#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fsm/rig/rig.h"

namespace fsm {

/// Some vertices of a head, moved on the processor as all of them would be: for what must be known
/// of a state whose other vertices are moved on a graphics card. Immutable; thread: any.
class PartialRig {
 public:
  /// `vertices`: indices of the head's, in any order, also twice.
  PartialRig(const Rig& whole, std::vector<std::uint32_t> vertices);
  /// As Rig::Evaluate, but fills only the positions of those vertices in `out`, which has the whole
  /// head's size, and no normals.
  void Evaluate(const FaceState& state, HeadVertices& out,
                std::span<const glm::vec3> swings = {}) const;

 private:
  std::size_t whole_size_;
  std::vector<std::uint32_t> vertices_;  // of the head, ascending
  Rig rig_;
};

}  // namespace fsm
