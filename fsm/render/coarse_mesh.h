#pragma once

#include <cstdint>
#include <vector>

#include "fsm/render/skin_creases.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The triangles of a head, part by part; they may use only some of its vertices.
struct HeadTriangles {
  std::vector<HeadSurface::Part> parts;
  std::vector<std::uint32_t> indices;
};

/// Simplifies a head. In each of the test states of vertex_features.cc no removed vertex lies more
/// than `error_mm` from the coarser surface; differences of normal, colour and texture coordinate
/// count as millimetres. Only hair and lashes may change at their borders, so no gaps open.
/// `creases`: those of the head, or empty. The result is deterministic.
HeadTriangles CoarseTriangles(const Head& head, const CreaseWeights& creases, float error_mm);

}  // namespace fsm
