#include "fsm/head/cloth_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <span>
#include <vector>

#include "fsm/base/number_table.h"
#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

constexpr int kPoints = 8;  // points of a half ring

/// A half ring of the shirt, from the median in front over the agent's left to the median behind.
struct ClothRing {
  float open;
  std::array<glm::vec3, kPoints> points;
};
ClothRing ClothRingOf(const std::array<float, 1 + 3 * kPoints>& n) {
  ClothRing ring{n[0], {}};
  for (std::size_t i = 0; i < kPoints; ++i) {
    ring.points[i] = {n[3 * i + 1], n[3 * i + 2], n[3 * i + 3]};
  }
  return ring;
}

/// The collar shades the skin beside it.
void ShadeNeck(const Features& features, std::span<const glm::vec3> collar, std::size_t skin,
               HeadMesh& mesh) {
  const float reach = features.shirt_shade.reach;
  for (std::size_t i = 0; i < skin; ++i) {
    float nearest = 1e9f;
    for (const glm::vec3 q : collar)
      nearest = std::min(nearest, glm::distance(mesh.position[i], q));
    const float near = nearest / reach;
    mesh.openness[i] *= 1 - features.shirt_shade.dark * std::exp(-near * near);
  }
}

/// Returns how far the neck turns beside a point of the collar, which turns with it.
float NeckWeightBeside(glm::vec3 p, std::size_t skin, const HeadMesh& mesh) {
  const auto nearest = std::ranges::min_element(std::span(mesh.position).first(skin), {},
                                                [p](glm::vec3 q) { return glm::distance(p, q); });
  return mesh.weights[static_cast<std::size_t>(nearest - std::span(mesh.position).begin())]
      .skin.neck;
}

/// Draws the skin below the collar's edge in, so that it does not come through the cloth. `collar`:
/// points all around.
void TuckNeck(const Features& features, std::span<const glm::vec3> collar, std::size_t skin,
              HeadMesh& mesh) {
  glm::vec3 axis(0);
  for (const glm::vec3 q : collar) axis += q / static_cast<float>(collar.size());
  const auto outward = [axis](glm::vec3 p) { return glm::vec2(p.x, p.z - axis.z); };
  for (std::size_t i = 0; i < skin; ++i) {
    glm::vec3& p = mesh.position[i];
    const glm::vec2 out = outward(p);
    const auto facing = [&](glm::vec3 q) { return glm::dot(out, glm::normalize(outward(q))); };
    const glm::vec3 edge = *std::ranges::max_element(collar, {}, facing);
    const float most = glm::length(outward(edge)) - features.shirt_tuck.inside;
    const float radius = glm::length(out);
    if (radius <= most) continue;
    const float tucked = SmoothStep(features.shirt_tuck.below, edge.y - p.y);
    const glm::vec2 drawn = out * glm::mix(1.0f, most / radius, tucked);
    p = {drawn.x, p.y, axis.z + drawn.y};
  }
}

}  // namespace

void BuildCloth(const Identity& identity, HeadMesh& mesh) {
  const Features& features = identity.UsedFeatures();
  constexpr int kHalf = 12;  // columns of one half
  // The first ring is row -1; the foot of the collar is row 0.
  constexpr std::array kRows = {-1.0f, 0.0f, 0.75f, 1.0f, 2.2f, 2.26f, 2.32f,
                                2.75f, 3.3f, 3.8f,  4.2f, 4.6f, 5.0f,  6.0f};
  constexpr std::size_t kCollar = 2, kSeam = 5;
  constexpr int kAround = 2 * kHalf + 1;
  std::vector<float> around_at, down_at;
  // Mirrored neighbours at both ends keep the surface smooth across the median.
  for (int i = -1; i <= kPoints; ++i) around_at.push_back(static_cast<float>(i));
  std::vector<ClothRing> rings;
  for (const auto* row : {&features.shirt_inside, &features.shirt_collar_foot,
                          &features.shirt_collar, &features.shirt_fold, &features.shirt_neckline,
                          &features.shirt_shoulder, &features.shirt_chest, &features.shirt_hem}) {
    down_at.push_back(static_cast<float>(rings.size()) - 1);
    rings.push_back(ClothRingOf(*row));
  }
  const SplineBasis around(around_at);
  const SplineBasis down(down_at);
  std::vector<float> wa(around_at.size()), wd(down_at.size());
  BakeWeights weights;
  weights.skin.free = weights.skin.neck = weights.skin.jaw = 0;
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (std::size_t r = 0; r < kRows.size(); ++r) {
    const float row = kRows[r];
    const float light = r == kSeam  ? features.shirt_seam.dark
                        : r < kSeam ? features.shirt_seam.band
                                    : 1.0f;
    down.Weights(row, wd);
    float open = 0;
    for (std::size_t k = 0; k < rings.size(); ++k) open += wd[k] * rings[k].open;
    for (int c = 0; c < kAround; ++c) {
      // From the back over the agent's left to the front, then over the right to the back.
      const bool left = c <= kHalf;
      const int k = left ? kHalf - c : c - kHalf;
      around.Weights(static_cast<float>(k) * (kPoints - 1) / kHalf, wa);
      glm::vec3 p(0);
      for (std::size_t ring = 0; ring < rings.size(); ++ring) {
        for (int i = -1; i <= kPoints; ++i) {
          const int from = i < 0 ? 1 : i == kPoints ? kPoints - 2 : i;
          glm::vec3 q = rings[ring].points[static_cast<std::size_t>(from)];
          if (from != i) q.x = -q.x;
          p += wd[ring] * wa[static_cast<std::size_t>(i + 1)] * q;
        }
      }
      if (k == 0 || k == kHalf) p.x = 0;
      if (!left) p.x = -p.x;
      const float of_collar = SmoothStep(2.2f, 1, row);
      weights.skin.neck = of_collar > 0 ? of_collar * NeckWeightBeside(p, first, mesh) : 0;
      mesh.Add(p, light * identity.palette.cloth, glm::clamp(open, 0.2f, 1.0f), Bone::kSkin,
               weights);
    }
  }
  const std::vector<glm::vec3> collar(mesh.position.begin() + first + kCollar * kAround,
                                      mesh.position.begin() + first + (kCollar + 1) * kAround);
  TuckNeck(features, collar, first, mesh);
  ShadeNeck(features, collar, first, mesh);
  mesh.Grid(Material::kCloth, first, static_cast<int>(kRows.size()), kAround, true);
}

}  // namespace fsm
