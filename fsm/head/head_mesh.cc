#include "fsm/head/head_mesh.h"

#include <algorithm>
#include <cmath>

#include "fsm/base/smooth_step.h"

namespace fsm {

std::uint32_t HeadMesh::Add(glm::vec3 p, glm::vec3 colour, float open, Bone b,
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

void HeadMesh::Triangle(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                        bool flip) {
  if (a == b || b == c || c == a) return;
  auto& indices = BatchOf(material).indices;
  indices.insert(indices.end(), {a, flip ? c : b, flip ? b : c});
}

HeadMesh::Batch& HeadMesh::BatchOf(Material material, int pbr, bool two_sided) {
  const auto found = std::ranges::find_if(batches, [&](const Batch& batch) {
    return batch.material == material && batch.pbr == pbr && batch.two_sided == two_sided;
  });
  if (found != batches.end()) return *found;
  return batches.emplace_back(Batch{material, {}, pbr, two_sided});
}

void HeadMesh::Quad(Material material, std::uint32_t a, std::uint32_t b, std::uint32_t c,
                    std::uint32_t d) {
  Triangle(material, a, b, c);
  Triangle(material, a, c, d);
}

void HeadMesh::Grid(Material material, std::uint32_t first, int rows, int columns, bool flip) {
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

void SetParts(std::span<const HeadMesh::Batch> batches, HeadTopology& topology) {
  for (const HeadMesh::Batch& batch : batches) {
    topology.parts.push_back({batch.material, static_cast<std::uint32_t>(topology.indices.size()),
                              static_cast<std::uint32_t>(batch.indices.size()), batch.pbr,
                              batch.two_sided});
    topology.indices.insert(topology.indices.end(), batch.indices.begin(), batch.indices.end());
  }
}

SkinWeights SkinWeightsAt(glm::vec2 domain, int side, float mouth_line_y) {
  SkinWeights weights;
  weights.domain = domain;
  const float a = std::abs(domain.x);
  const float below = mouth_line_y - domain.y;  // millimetres below the line of the mouth
  const float beyond = std::max(0.0f, a - 25.0f);

  // Along the slit the lower lip follows the jaw fully at the median, the upper lip hardly, and the
  // corner almost by half; both reach it along a quarter ellipse, so that an open mouth is oval.
  // After ICT-FaceKit's jawOpen: the upper lip moves 7 % as far as the lower at the median, 10 % at
  // 10 mm, the corner 43 %; the lower lip 88 % at 10 mm, 75 % at 18 mm.
  constexpr float kApart = 24.4f;  // millimetres from the median; beyond, the lips stay together
  const float apart = std::sqrt(std::max(0.0f, 1 - a * a / (kApart * kApart)));
  const float upper_seam = 0.06f + 0.40f * (1 - apart * apart);
  const float lower_seam = upper_seam + (1 - upper_seam) * apart;
  const float reach_down = 16 + 0.5f * beyond;
  const float reach_up = 18 + 0.5f * beyond;
  const float fades = 8 + 0.3f * beyond;
  const float along_slit = side == 0 ? 1.0f : 1 - SmoothStep(25, 19, a);
  if (side < 0 || (side == 0 && below > 0)) {  // the lower lip
    weights.jaw = lower_seam + (1 - lower_seam) * SmoothStep(0, reach_down, below);
    weights.above_mouth = 0.5f * along_slit * (1 - SmoothStep(0, side < 0 ? 12 : fades, below));
  } else {
    weights.jaw = upper_seam * (1 - SmoothStep(0, reach_up, -below));
    weights.above_mouth = 1 - 0.5f * along_slit * (1 - SmoothStep(0, fades, -below));
  }
  // The skin of the jaw ends at the throat and in front of the ear.
  weights.jaw *= SmoothStep(-138, -84, domain.y) * SmoothStep(112, 62, a);

  // The neck twists: it turns fully at the jaw and not at the shoulders.
  weights.neck = SmoothStep(-168, -96, domain.y);
  return weights;
}

}  // namespace fsm
