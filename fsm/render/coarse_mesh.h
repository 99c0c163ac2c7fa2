#pragma once

#include <cstdint>
#include <vector>

#include "fsm/render/skin_texture.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The triangles of a head, part by part, of all or of some of its vertices.
struct HeadTriangles {
  std::vector<HeadTopology::Part> parts;
  std::vector<std::uint32_t> indices;
};

/// The triangles of a head without the vertices that are not missed: in none of some far-reaching
/// states of the face is such a vertex more than `error_mm` away from the coarser surface, nor does
/// what is shown there (normal, colour, place in textures) differ by more than counts as much
/// (vertex_features.cc). Only hair and lashes change at their borders, so nothing comes apart.
/// `creases`: of the head, or empty. Always the same for the same head.
HeadTriangles CoarseTriangles(const Head& head, const CreaseWeights& creases, float error_mm);

}  // namespace fsm
