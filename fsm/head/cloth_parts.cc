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
               MeshBuilder& mesh) {
  const float reach = features.shirt_shade.reach;
  for (std::size_t i = 0; i < skin; ++i) {
    float nearest = 1e9f;
    for (const glm::vec3 q : collar)
      nearest = std::min(nearest, glm::distance(mesh.position[i], q));
    const float near = nearest / reach;
    mesh.openness[i] *= 1 - features.shirt_shade.dark * std::exp(-near * near);
  }
}

/// Returns how far the neck turns beside a point of the cloth.
float NeckWeightBeside(glm::vec3 p, std::size_t skin, const MeshBuilder& mesh) {
  const auto nearest = std::ranges::min_element(std::span(mesh.position).first(skin), {},
                                                [p](glm::vec3 q) { return glm::distance(p, q); });
  return mesh.weights[static_cast<std::size_t>(nearest - std::span(mesh.position).begin())]
      .skin.neck;
}

/// Returns how far each point of a ring of the cloth turns with the neck, evenly along the ring,
/// for the skin's own weights step from vertex to vertex.
std::vector<float> NeckWeights(std::span<const glm::vec3> ring, std::size_t skin,
                               const MeshBuilder& mesh) {
  std::vector<float> weights;
  for (const glm::vec3 p : ring) weights.push_back(NeckWeightBeside(p, skin, mesh));
  constexpr int kRounds = 12;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<float> before = weights;
    for (std::size_t i = 1; i + 1 < weights.size(); ++i) {
      weights[i] = 0.25f * before[i - 1] + 0.5f * before[i] + 0.25f * before[i + 1];
    }
  }
  return weights;
}

/// Draws the skin below the collar's edge in, so that it does not come through the cloth. `collar`:
/// points all around.
void PullNeckInside(const Features& features, std::span<const glm::vec3> collar, std::size_t skin,
                    MeshBuilder& mesh) {
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
    const float tucked = features.shirt_tuck.below.Ramp(edge.y - p.y);
    const glm::vec2 drawn = out * glm::mix(1.0f, most / radius, tucked);
    p = {drawn.x, p.y, axis.z + drawn.y};
  }
}

/// The surface through the rings of the shirt. Rows are counted in rings: the first is row -1, the
/// foot of the collar row 0. Columns run from the back over the agent's left to the front, then
/// over the right to the back.
class ClothSurface {
 public:
  static constexpr int kHalf = 20;  ///< columns of one half
  static constexpr int kAround = 2 * kHalf + 1;

  explicit ClothSurface(const Features& features) {
    for (const auto* row : {&features.shirt_inside, &features.shirt_collar_foot,
                            &features.shirt_collar, &features.shirt_fold, &features.shirt_neckline,
                            &features.shirt_shoulder, &features.shirt_chest, &features.shirt_hem}) {
      rings_.push_back(ClothRingOf(*row));
    }
  }

  /// Returns the openness to light of a row.
  float Open(float row) const {
    const auto of_ring = Weights(down_, row);
    float open = 0;
    for (std::size_t k = 0; k < rings_.size(); ++k) open += of_ring[k] * rings_[k].open;
    return open;
  }

  glm::vec3 Point(float row, int column) const {
    const bool left = column <= kHalf;
    const int k = left ? kHalf - column : column - kHalf;  // from the median in front
    const auto of_ring = Weights(down_, row);
    const auto of_point = Weights(around_, static_cast<float>(k) * (kPoints - 1) / kHalf);
    glm::vec3 p(0);
    for (std::size_t ring = 0; ring < rings_.size(); ++ring) {
      for (int i = -1; i <= kPoints; ++i) {
        const int from = i < 0 ? 1 : i == kPoints ? kPoints - 2 : i;
        glm::vec3 q = rings_[ring].points[static_cast<std::size_t>(from)];
        if (from != i) q.x = -q.x;
        p += of_ring[ring] * of_point[static_cast<std::size_t>(i + 1)] * q;
      }
    }
    if (k == 0 || k == kHalf) p.x = 0;
    if (!left) p.x = -p.x;
    return p;
  }

 private:
  /// Returns a basis with knots at -1, 0, 1 ...
  static SplineBasis Basis(std::size_t knots) {
    std::vector<float> at;
    for (std::size_t i = 0; i < knots; ++i) at.push_back(static_cast<float>(i) - 1);
    return SplineBasis(std::move(at));
  }
  static std::vector<float> Weights(const SplineBasis& basis, float t) {
    std::vector<float> weights(basis.knots().size());
    basis.Weights(t, weights);
    return weights;
  }

  std::vector<ClothRing> rings_;
  const SplineBasis down_ = Basis(8);
  // Mirrored neighbours at both ends keep the surface smooth across the median.
  const SplineBasis around_ = Basis(kPoints + 2);
};

}  // namespace

void BuildCloth(const Identity& identity, MeshBuilder& mesh) {
  const Features& features = *identity.features;
  const ClothSurface surface(features);
  constexpr int kAround = ClothSurface::kAround;
  constexpr std::array kRows = {-1.0f, 0.0f, 0.75f, 1.0f, 2.2f, 2.26f, 2.32f, 2.75f,
                                3.05f, 3.3f, 3.55f, 3.8f, 4.2f, 4.6f,  5.0f,  6.0f};
  constexpr std::size_t kCollar = 2, kSeam = 5;
  BakeWeights weights;
  weights.skin.free = weights.skin.neck = weights.skin.jaw = 0;
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (std::size_t r = 0; r < kRows.size(); ++r) {
    const float row = kRows[r];
    const float light = r == kSeam  ? features.shirt_seam.dark
                        : r < kSeam ? features.shirt_seam.band
                                    : 1.0f;
    const float open = glm::clamp(surface.Open(row), 0.2f, 1.0f);
    const float of_collar = SmoothStep(2.2f, 1, row);
    std::vector<glm::vec3> ring;
    for (int c = 0; c < kAround; ++c) ring.push_back(surface.Point(row, c));
    const std::vector<float> neck =
        of_collar > 0 ? NeckWeights(ring, first, mesh) : std::vector<float>(ring.size());
    for (std::size_t c = 0; c < ring.size(); ++c) {
      weights.skin.neck = of_collar * neck[c];
      mesh.Add(ring[c], light * identity.palette.cloth, open, Bone::kSkin, weights);
    }
  }
  const std::vector<glm::vec3> collar(mesh.position.begin() + first + kCollar * kAround,
                                      mesh.position.begin() + first + (kCollar + 1) * kAround);
  PullNeckInside(features, collar, first, mesh);
  ShadeNeck(features, collar, first, mesh);
  mesh.Grid(Material::kCloth, first, static_cast<int>(kRows.size()), kAround, true);
}

}  // namespace fsm
