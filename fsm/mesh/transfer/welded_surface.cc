#include "fsm/mesh/transfer/welded_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>

#include "fsm/base/smooth_step.h"

namespace fsm {
namespace {

/// A depth buffer: the greatest z of the surface at the points of a grid.
class FrontDepth {
 public:
  explicit FrontDepth(std::span<const glm::vec3> points) {
    glm::vec2 high(-1e9f);
    for (const glm::vec3& p : points) {
      low_ = glm::min(low_, glm::vec2(p));
      high = glm::max(high, glm::vec2(p));
    }
    size_ = glm::ivec2(glm::clamp((high - low_) / kCell + 2.0f, 2.0f, float{kMax}));
    front_.assign(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y), -1e9f);
  }

  void Rasterize(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area <= 1e-6f) return;  // facing away
    const glm::vec2 least = glm::min(glm::vec2(a), glm::min(glm::vec2(b), glm::vec2(c)));
    const glm::vec2 most = glm::max(glm::vec2(a), glm::max(glm::vec2(b), glm::vec2(c)));
    const glm::ivec2 from(glm::max((least - low_) / kCell, 0.0f));
    const glm::ivec2 to = glm::min(glm::ivec2(glm::max(most - low_, 0.0f) / kCell) + 1, size_ - 1);
    if (from.x > to.x || from.y > to.y) return;
    const std::int64_t box = std::int64_t{to.x - from.x + 1} * (to.y - from.y + 1);
    if (box > kMaxOfTriangle) return;
    if (covered_ += box; covered_ > WeldedSurface::kMaxCovered) {
      throw std::runtime_error(
          "its triangles lie in too many layers: their boxes cover more than " +
          std::to_string(WeldedSurface::kMaxCovered / 1'000'000) + " square metres");
    }
    for (int y = from.y; y <= to.y; ++y) {
      for (int x = from.x; x <= to.x; ++x) {
        const glm::vec2 p = low_ + kCell * glm::vec2(x, y);
        const float u = ((p.x - a.x) * (c.y - a.y) - (c.x - a.x) * (p.y - a.y)) / area;
        const float v = ((b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const float z = a.z * (1 - u - v) + b.z * u + c.z * v;
        At(x, y) = std::max(At(x, y), z);
      }
    }
  }

  /// Returns the least depth of the four points around p, so that p is visible on slopes and at
  /// edges.
  float LeastAround(glm::vec3 p) {
    const glm::ivec2 cell = glm::min(glm::ivec2((glm::vec2(p) - low_) / kCell), size_ - 2);
    return std::min({At(cell.x, cell.y), At(cell.x + 1, cell.y), At(cell.x, cell.y + 1),
                     At(cell.x + 1, cell.y + 1)});
  }

 private:
  static constexpr float kCell = 1;  // millimetres
  static constexpr int kMax = 2000;  // cells
  static constexpr std::int64_t kMaxOfTriangle = 1'000'000;

  float& At(int x, int y) {
    return front_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) +
                  static_cast<std::size_t>(x)];
  }

  glm::vec2 low_{1e9f};
  glm::ivec2 size_;
  std::vector<float> front_;
  std::int64_t covered_ = 0;
};

}  // namespace

WeldedSurface::WeldedSurface(std::span<const glm::vec3> given_position,
                             std::span<const std::uint32_t> given, bool has_uv_seams) {
  // Preliminary normals distinguish a texture seam, across which the surface continues, from lips
  // that touch.
  std::vector<glm::vec3> own(given_position.size(), glm::vec3(0));
  for (std::size_t i = 0; i + 2 < given.size(); i += 3) {
    const glm::vec3 a = given_position[given[i]];
    const glm::vec3 n =
        glm::cross(given_position[given[i + 1]] - a, given_position[given[i + 2]] - a);
    for (std::size_t k = 0; k < 3; ++k) own[given[i + k]] += n;
  }
  welded_of.assign(given_position.size(), kNone);
  std::map<std::tuple<long, long, long>, std::vector<std::uint32_t>> there;
  const auto weld = [&](std::uint32_t v) {
    if (welded_of[v] != kNone) return welded_of[v];
    const auto key = [](float x) { return std::lround(x * 200); };
    const glm::vec3 p = given_position[v];
    const glm::vec3 n = own[v] / std::max(glm::length(own[v]), 1e-12f);
    auto& same = there[{key(p.x), key(p.y), key(p.z)}];
    for (const std::uint32_t w : has_uv_seams ? same : std::vector<std::uint32_t>()) {
      const glm::vec3 m = own[given_of[w]] / std::max(glm::length(own[given_of[w]]), 1e-12f);
      if (glm::dot(n, m) > 0.9f) return welded_of[v] = w;
    }
    position.push_back(p);
    given_of.push_back(v);
    same.push_back(static_cast<std::uint32_t>(position.size() - 1));
    return welded_of[v] = same.back();
  };
  for (std::size_t i = 0; i + 2 < given.size(); i += 3) {
    const std::array<std::uint32_t, 3> t{weld(given[i]), weld(given[i + 1]), weld(given[i + 2])};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  neighbours = NeighboursAlongEdges(position.size(), triangles);
  lip.assign(position.size(), 0);
  lid.assign(position.size(), 0);
  ComputeNormals();
}

void WeldedSurface::ComputeNormals() {
  normal.assign(position.size(), glm::vec3(0));
  for (const auto& t : triangles) {
    const glm::vec3 n =
        glm::cross(position[t[1]] - position[t[0]], position[t[2]] - position[t[0]]);
    for (const std::uint32_t v : t) normal[v] += n;
  }
  for (glm::vec3& n : normal) n /= std::max(glm::length(n), 1e-12f);
}

void WeldedSurface::ComputeVisibility(std::span<const glm::vec3> given_position,
                                      std::span<const std::uint32_t> eyes) {
  constexpr float kClear = 0.5f, kBehind = 3;  // millimetres
  FrontDepth front(position);
  for (const auto& t : triangles) front.Rasterize(position[t[0]], position[t[1]], position[t[2]]);
  for (std::size_t k = 0; k + 2 < eyes.size(); k += 3) {
    front.Rasterize(given_position[eyes[k]], given_position[eyes[k + 1]],
                    given_position[eyes[k + 2]]);
  }
  visibility.resize(position.size());
  for (std::size_t i = 0; i < position.size(); ++i) {
    visibility[i] = SmoothStep(kBehind, kClear, front.LeastAround(position[i]) - position[i].z);
  }
}

float WeldedSurface::MeanEdge(std::size_t vertex) const {
  float sum = 0;
  for (const std::uint32_t n : neighbours[vertex])
    sum += glm::distance(position[vertex], position[n]);
  return sum / std::max(static_cast<float>(neighbours[vertex].size()), 1.0f);
}

std::uint32_t WeldedSurface::Nearest(glm::vec3 p) const {
  std::uint32_t best = 0;
  float least = 1e30f;
  for (std::uint32_t i = 0; i < position.size(); ++i) {
    const glm::vec3 d = position[i] - p;
    const float distance2 = glm::dot(d, d);
    if (distance2 < least) {
      least = distance2;
      best = i;
    }
  }
  return best;
}

std::vector<float> WeldedSurface::DistancesFrom(std::span<const glm::vec3> seeds,
                                                float reach) const {
  std::vector<std::uint32_t> from;
  for (const glm::vec3& seed : seeds) from.push_back(Nearest(seed));
  return ShortestPaths(neighbours, position, from, reach).length;
}

}  // namespace fsm
