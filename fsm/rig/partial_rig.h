#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fsm/rig/rig.h"

namespace fsm {

/// Some vertices of a head, moved on the processor exactly as Rig would move them. It serves
/// queries about a state whose other vertices are moved on a GPU. Immutable; thread: any.
class PartialRig {
 public:
  /// `vertices`: indices into the head's vertices, in any order; repetitions are allowed.
  PartialRig(const Rig& whole, std::vector<std::uint32_t> vertices);
  /// Does what Rig::Evaluate does, but fills only the positions of those vertices in `out`, which
  /// gets the whole head's size, and no normals.
  void Evaluate(const FaceState& state, HeadVertices& out,
                std::span<const glm::vec3> spring_offsets = {}) const;

 private:
  std::size_t whole_size_;
  std::vector<std::uint32_t> vertices_;  // indices into the whole head, ascending
  Rig rig_;
};

}  // namespace fsm
