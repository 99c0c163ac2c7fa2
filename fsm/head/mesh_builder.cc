#include "fsm/head/mesh_builder.h"

#include <algorithm>

#include "fsm/base/smooth_step.h"

namespace fsm {

std::uint32_t MeshBuilder::Add(glm::vec3 p, glm::vec3 colour, float open, Bone b,
                               const BakeWeights& vertex_weights) {
  position.push_back(p);
  albedo.push_back(colour);
  openness.push_back(open);
  bone.push_back(b);
  weights.push_back(vertex_weights);
  opacity.push_back(1);
  strands.push_back({});
  return static_cast<std::uint32_t>(position.size() - 1);
}

void MeshBuilder::Triangle(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                           bool flip) {
  if (a == b || b == c || c == a) return;
  auto& indices = BatchOf(material).indices;
  indices.insert(indices.end(), {a, flip ? c : b, flip ? b : c});
}

MeshBuilder::Batch& MeshBuilder::BatchOf(Material material, int pbr, bool two_sided) {
  const auto found = std::ranges::find_if(batches, [&](const Batch& batch) {
    return batch.material == material && batch.pbr == pbr && batch.two_sided == two_sided;
  });
  if (found != batches.end()) return *found;
  return batches.emplace_back(Batch{material, {}, pbr, two_sided});
}

void MeshBuilder::Quad(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                       std::uint32_t d) {
  Triangle(material, a, b, c);
  Triangle(material, a, c, d);
}

void MeshBuilder::Grid(Material material, std::uint32_t first, int rows, int columns, bool flip) {
  const auto at = [&](int r, int c) { return first + static_cast<std::uint32_t>(r * columns + c); };
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      if (flip) {
        Quad(material, at(r, c), at(r, c + 1), at(r + 1, c + 1), at(r + 1, c));
      } else {
        Quad(material, at(r, c), at(r + 1, c), at(r + 1, c + 1), at(r, c + 1));
      }
    }
  }
}

void SetParts(std::span<const MeshBuilder::Batch> batches, HeadSurface& surface) {
  for (const MeshBuilder::Batch& batch : batches) {
    surface.parts.push_back({batch.material, static_cast<std::uint32_t>(surface.indices.size()),
                             static_cast<std::uint32_t>(batch.indices.size()), batch.pbr,
                             batch.two_sided});
    surface.indices.insert(surface.indices.end(), batch.indices.begin(), batch.indices.end());
  }
}

float NeckWeight(float y) { return SmoothStep(-166, -98, y); }

}  // namespace fsm
