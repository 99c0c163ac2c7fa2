#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace fsm {

/// For each vertex the vertices that it shares an edge with, in ascending order.
using Neighbours = std::vector<std::vector<std::uint32_t>>;
Neighbours NeighboursAlongEdges(std::size_t vertices,
                                std::span<const std::array<std::uint32_t, 3>> triangles);

/// Per vertex, the length of the shortest path along edges to a seed, and the index of that seed.
struct MeshPaths {
  std::vector<float> length;  ///< `reach` if no seed is nearer
  std::vector<std::uint32_t> seed;
};
MeshPaths ShortestPaths(const Neighbours& next, std::span<const glm::vec3> position,
                        std::span<const std::uint32_t> seeds, float reach);

}  // namespace fsm
