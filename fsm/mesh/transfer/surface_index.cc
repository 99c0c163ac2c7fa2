#include "fsm/mesh/transfer/surface_index.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

namespace fsm {
namespace {

/// Returns the barycentric coordinates of the point of a triangle nearest to p (Ericson, Real-Time
/// Collision Detection, 5.1.5).
glm::vec3 NearestBarycentric(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  const glm::vec3 ab = b - a, ac = c - a, ap = p - a;
  const float d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const glm::vec3 bp = p - b;
  const float d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const glm::vec3 cp = p - c;
  const float d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const float v = d1 / std::max(d1 - d3, 1e-12f);
    return {1 - v, v, 0};
  }
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const float w = d2 / std::max(d2 - d6, 1e-12f);
    return {1 - w, 0, w};
  }
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const float w = (d4 - d3) / std::max((d4 - d3) + (d5 - d6), 1e-12f);
    return {0, 1 - w, w};
  }
  const float sum = std::max(va + vb + vc, 1e-20f);
  return {1 - vb / sum - vc / sum, vb / sum, vc / sum};
}

}  // namespace

SurfaceIndex::SurfaceIndex(const WeldedSurface& surface, float reach)
    : surface_(surface), reach_(reach), cell_(std::max(reach / 2, 1.0f)) {
  std::int64_t cells = 0;
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& t = surface.triangles[i];
    const glm::vec3 low =
        glm::min(surface.position[t[0]], glm::min(surface.position[t[1]], surface.position[t[2]]));
    const glm::vec3 high =
        glm::max(surface.position[t[0]], glm::max(surface.position[t[1]], surface.position[t[2]]));
    low_.push_back(low);
    high_.push_back(high);
    const glm::ivec3 a(glm::floor(low / cell_)), b(glm::floor(high / cell_));
    // Each side has at most 2e7 cells; the product of three needs more than 64 bits.
    const std::int64_t across = b.x - a.x + 1, up = b.y - a.y + 1, deep = b.z - a.z + 1;
    if (across * up > kMaxCellsOfTriangle || across * up * deep > kMaxCellsOfTriangle) continue;
    if (cells += across * up * deep; cells > kMaxCells) {
      throw std::runtime_error(
          "its triangles are too large or too many to be told apart: they lie "
          "in more than " +
          std::to_string(kMaxCells) + " cells of " + std::to_string(std::lround(cell_)) + " mm");
    }
    for (int x = a.x; x <= b.x; ++x) {
      for (int y = a.y; y <= b.y; ++y) {
        for (int z = a.z; z <= b.z; ++z) cells_[Cell({x, y, z})].push_back(i);
      }
    }
  }
}

std::int64_t SurfaceIndex::Cell(glm::ivec3 c) {
  // Cells beyond 100,000 may share a number, which costs time but does not change results.
  return ((static_cast<std::int64_t>(c.x) + 100000) * 200003 + c.y + 100000) * 200003 + c.z +
         100000;
}

std::optional<SurfaceIndex::Hit> SurfaceIndex::Find(const WeldedSurface& other,
                                                    std::size_t vertex) const {
  // Penalties in millimetres: for facing away, the opposite lip, the opposite lid, hidden. Only
  // opposites are penalised, because how clearly a point belongs to a lip, at a corner or within
  // the mouth, differs between heads.
  constexpr float kTurned = 4, kLip = 28, kLid = 18, kHidden = 10;
  const glm::vec3 p = other.position[vertex], normal = other.normal[vertex];
  constexpr float kMinFacing = 0.15f;
  std::optional<Hit> best;
  float least = reach_ * reach_;
  const glm::ivec3 low(glm::floor((p - reach_) / cell_)), high(glm::floor((p + reach_) / cell_));
  for (int x = low.x; x <= high.x; ++x) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int z = low.z; z <= high.z; ++z) {
        const auto found = cells_.find(Cell({x, y, z}));
        if (found == cells_.end()) continue;
        for (const std::uint32_t i : found->second) {
          // No point of a triangle is nearer than its bounding box; the margin is for rounding.
          const glm::vec3 outside = glm::max(glm::max(low_[i] - p, p - high_[i]), 0.0f);
          if (glm::dot(outside, outside) > 1.001f * least + 1e-6f) continue;
          const auto& t = surface_.triangles[i];
          const glm::vec3 part = NearestBarycentric(
              p, surface_.position[t[0]], surface_.position[t[1]], surface_.position[t[2]]);
          const auto mix = [&](const auto& v) {
            return v[t[0]] * part.x + v[t[1]] * part.y + v[t[2]] * part.z;
          };
          const glm::vec3 there = mix(surface_.position);
          const glm::vec3 d = there - p;
          float cost = glm::dot(d, d);
          if (cost >= least) continue;
          const float facing = glm::dot(normal, mix(surface_.normal));
          if (facing < kMinFacing) continue;
          const float turned = kTurned * (1 - facing);
          const auto opposite = [](float a, float b) { return std::max(-a * b, 0.0f); };
          const float lip = kLip * opposite(other.lip[vertex], mix(surface_.lip));
          const float lid = kLid * opposite(other.lid[vertex], mix(surface_.lid));
          const float hidden = kHidden * (other.visibility[vertex] - mix(surface_.visibility));
          cost += turned * turned + lip * lip + lid * lid + hidden * hidden;
          if (cost >= least) continue;
          least = cost;
          best = Hit{i, part, there, glm::length(d)};
        }
      }
    }
  }
  return best;
}

}  // namespace fsm
