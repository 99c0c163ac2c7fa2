#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fsm {

/// For each vertex those it shares an edge with, in order.
using Neighbours = std::vector<std::vector<std::uint32_t>>;
Neighbours NeighboursAlongEdges(std::size_t vertices,
                                std::span<const std::array<std::uint32_t, 3>> triangles);

/// By vertex: how long the way along edges is to the nearest seed, and the number of that seed.
struct MeshPaths {
  std::vector<float> length;  ///< `reach` where no seed is nearer
  std::vector<std::uint32_t> seed;
};
MeshPaths ShortestPaths(const Neighbours& next, std::span<const glm::vec3> at,
                        std::span<const std::uint32_t> seeds, float reach);

}  // namespace fsm
