#include "fsm/mesh/transfer/mesh_paths.h"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <queue>
#include <tuple>

namespace fsm {

Neighbours NeighboursAlongEdges(std::size_t vertices,
                                std::span<const std::array<std::uint32_t, 3>> triangles) {
  Neighbours next(vertices);
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      next[t[k]].push_back(t[(k + 1) % 3]);
      next[t[(k + 1) % 3]].push_back(t[k]);
    }
  }
  for (auto& list : next) {
    std::ranges::sort(list);
    const auto doubled = std::ranges::unique(list);
    list.erase(doubled.begin(), doubled.end());
  }
  return next;
}

MeshPaths ShortestPaths(const Neighbours& next, std::span<const glm::vec3> position,
                        std::span<const std::uint32_t> seeds, float reach) {
  MeshPaths paths{std::vector<float>(position.size(), reach),
                  std::vector<std::uint32_t>(position.size())};
  using QueueEntry = std::tuple<float, std::uint32_t, std::uint32_t>;  // length, seed, last vertex
  std::priority_queue<QueueEntry, std::vector<QueueEntry>, std::greater<>> open;
  for (std::uint32_t k = 0; k < seeds.size(); ++k) open.emplace(0.0f, k, seeds[k]);
  while (!open.empty()) {
    const auto [length, seed, v] = open.top();
    open.pop();
    if (length >= paths.length[v]) continue;
    paths.length[v] = length;
    paths.seed[v] = seed;
    for (const std::uint32_t w : next[v]) {
      const float new_length = length + glm::distance(position[v], position[w]);
      if (new_length < paths.length[w]) open.emplace(new_length, seed, w);
    }
  }
  return paths;
}

}  // namespace fsm
