#pragma once

#include <cstdint>
#include <vector>

#include "fsm/render/skin_creases.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The triangles of a head, part by part, of all or of some of its vertices.
struct HeadTriangles {
  std::vector<HeadTopology::Part> parts;
  std::vector<std::uint32_t> indices;
};

/// Simplifies a head. In each of the test states of vertex_features.cc no removed vertex lies more
/// than `error_mm` from the coarser surface; differences in normal, colour and place in textures
/// are weighed as millimetres. Only hair and lashes change at their borders, so nothing comes
/// apart. `creases`: of the head, or empty. Always the same for the same head.
HeadTriangles CoarseTriangles(const Head& head, const CreaseWeights& creases, float error_mm);

}  // namespace fsm
