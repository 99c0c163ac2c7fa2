#include "fsm/mesh/surface_index.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <queue>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>

#include "fsm/base/spline.h"

namespace fsm {
namespace {

/// The point of a triangle nearest to p, as parts of its corners (Ericson, Real-Time Collision
/// Detection, 5.1.5).
glm::vec3 NearestPart(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
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

/// How far to the front the surface lies at the points of a grid over it.
class FrontDepth {
 public:
  explicit FrontDepth(std::span<const glm::vec3> points) {
    glm::vec2 high(-1e9f);
    for (const glm::vec3& p : points) {
      low_ = glm::min(low_, glm::vec2(p));
      high = glm::max(high, glm::vec2(p));
    }
    size_ = glm::ivec2(glm::clamp((high - low_) / kCell + 2.0f, 2.0f, float{kMost}));
    front_.assign(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y), -1e9f);
  }

  void Draw(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area <= 1e-6f) return;  // turned away
    const glm::vec2 least = glm::min(glm::vec2(a), glm::min(glm::vec2(b), glm::vec2(c)));
    const glm::vec2 most = glm::max(glm::vec2(a), glm::max(glm::vec2(b), glm::vec2(c)));
    const glm::ivec2 from(glm::max((least - low_) / kCell, 0.0f));
    const glm::ivec2 to = glm::min(glm::ivec2(glm::max(most - low_, 0.0f) / kCell) + 1, size_ - 1);
    if (from.x > to.x || from.y > to.y) return;
    const std::int64_t box = std::int64_t{to.x - from.x + 1} * (to.y - from.y + 1);
    if (box > kMostOfTriangle) return;
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

  /// The least of the four points around p: at a slope, and at the edge of an opening, p is seen.
  float LeastAround(glm::vec3 p) {
    const glm::ivec2 cell = glm::min(glm::ivec2((glm::vec2(p) - low_) / kCell), size_ - 2);
    return std::min({At(cell.x, cell.y), At(cell.x + 1, cell.y), At(cell.x, cell.y + 1),
                     At(cell.x + 1, cell.y + 1)});
  }

 private:
  static constexpr float kCell = 1;   // millimetres
  static constexpr int kMost = 2000;  // cells
  static constexpr std::int64_t kMostOfTriangle = 1'000'000;

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

WeldedSurface::WeldedSurface(std::span<const glm::vec3> position,
                             std::span<const std::uint32_t> given, bool has_uv_seams) {
  // A first guess of the normals tells a seam of the texture, where both sides run on, from lips
  // that touch.
  std::vector<glm::vec3> own(position.size(), glm::vec3(0));
  for (std::size_t i = 0; i + 2 < given.size(); i += 3) {
    const glm::vec3 a = position[given[i]];
    const glm::vec3 n = glm::cross(position[given[i + 1]] - a, position[given[i + 2]] - a);
    for (std::size_t k = 0; k < 3; ++k) own[given[i + k]] += n;
  }
  of.assign(position.size(), kNone);
  std::map<std::tuple<long, long, long>, std::vector<std::uint32_t>> there;
  const auto weld = [&](std::uint32_t v) {
    if (of[v] != kNone) return of[v];
    const auto key = [](float x) { return std::lround(x * 200); };
    const glm::vec3 p = position[v];
    const glm::vec3 n = own[v] / std::max(glm::length(own[v]), 1e-12f);
    auto& same = there[{key(p.x), key(p.y), key(p.z)}];
    for (const std::uint32_t w : has_uv_seams ? same : std::vector<std::uint32_t>()) {
      const glm::vec3 m = own[first[w]] / std::max(glm::length(own[first[w]]), 1e-12f);
      if (glm::dot(n, m) > 0.9f) return of[v] = w;
    }
    at.push_back(p);
    first.push_back(v);
    same.push_back(static_cast<std::uint32_t>(at.size() - 1));
    return of[v] = same.back();
  };
  for (std::size_t i = 0; i + 2 < given.size(); i += 3) {
    const std::array<std::uint32_t, 3> t{weld(given[i]), weld(given[i + 1]), weld(given[i + 2])};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  next.resize(at.size());
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      next[t[k]].push_back(t[(k + 1) % 3]);
      next[t[(k + 1) % 3]].push_back(t[k]);
    }
  }
  for (auto& list : next) {
    std::ranges::sort(list);
    const auto rest = std::ranges::unique(list);
    list.erase(rest.begin(), rest.end());
  }
  lip.assign(at.size(), 0);
  lid.assign(at.size(), 0);
  FindNormals();
}

void WeldedSurface::FindNormals() {
  normal.assign(at.size(), glm::vec3(0));
  for (const auto& t : triangles) {
    const glm::vec3 n = glm::cross(at[t[1]] - at[t[0]], at[t[2]] - at[t[0]]);
    for (const std::uint32_t v : t) normal[v] += n;
  }
  for (glm::vec3& n : normal) n /= std::max(glm::length(n), 1e-12f);
}

void WeldedSurface::FindSeen(std::span<const glm::vec3> position,
                             std::span<const std::uint32_t> eyes) {
  constexpr float kClear = 0.5f, kBehind = 3;  // millimetres
  FrontDepth front(at);
  for (const auto& t : triangles) front.Draw(at[t[0]], at[t[1]], at[t[2]]);
  for (std::size_t k = 0; k + 2 < eyes.size(); k += 3) {
    front.Draw(position[eyes[k]], position[eyes[k + 1]], position[eyes[k + 2]]);
  }
  seen.resize(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) {
    seen[i] = SmoothStep(kBehind, kClear, front.LeastAround(at[i]) - at[i].z);
  }
}

std::uint32_t WeldedSurface::Nearest(glm::vec3 p) const {
  std::uint32_t best = 0;
  float least = 1e30f;
  for (std::uint32_t i = 0; i < at.size(); ++i) {
    const glm::vec3 d = at[i] - p;
    const float far = glm::dot(d, d);
    if (far < least) {
      least = far;
      best = i;
    }
  }
  return best;
}

std::vector<float> WeldedSurface::DistancesFrom(std::span<const glm::vec3> seeds,
                                                float reach) const {
  std::vector<float> far(at.size(), reach);
  using Way = std::pair<float, std::uint32_t>;
  std::priority_queue<Way, std::vector<Way>, std::greater<>> open;
  for (const glm::vec3& seed : seeds) {
    const std::uint32_t v = Nearest(seed);
    far[v] = 0;
    open.emplace(0.0f, v);
  }
  while (!open.empty()) {
    const auto [way, v] = open.top();
    open.pop();
    if (way > far[v]) continue;
    for (const std::uint32_t w : next[v]) {
      const float on = way + glm::distance(at[v], at[w]);
      if (on >= far[w]) continue;
      far[w] = on;
      open.emplace(on, w);
    }
  }
  return far;
}

SurfaceIndex::SurfaceIndex(const WeldedSurface& surface, float reach)
    : surface_(surface), reach_(reach), cell_(std::max(reach / 2, 1.0f)) {
  std::int64_t cells = 0;
  for (std::uint32_t i = 0; i < surface.triangles.size(); ++i) {
    const auto& t = surface.triangles[i];
    const glm::vec3 low = glm::min(surface.at[t[0]], glm::min(surface.at[t[1]], surface.at[t[2]]));
    const glm::vec3 high = glm::max(surface.at[t[0]], glm::max(surface.at[t[1]], surface.at[t[2]]));
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
  // Cells farther away than 100,000 may share a number, which costs time and changes nothing.
  return ((static_cast<std::int64_t>(c.x) + 100000) * 200003 + c.y + 100000) * 200003 + c.z +
         100000;
}

std::optional<SurfaceIndex::Hit> SurfaceIndex::Find(const WeldedSurface& other,
                                                    std::size_t vertex) const {
  // Millimetres that a difference counts: turned away, on the other lip, on the other lid, hidden.
  // Only opposites are kept apart: how clearly a place belongs to one, at a corner or within the
  // mouth, differs from head to head.
  constexpr float kTurned = 4, kLip = 28, kLid = 18, kHidden = 10;
  const glm::vec3 p = other.at[vertex], normal = other.normal[vertex];
  constexpr float kLeastFacing = 0.15f;
  std::optional<Hit> best;
  float least = reach_ * reach_;
  const glm::ivec3 low(glm::floor((p - reach_) / cell_)), high(glm::floor((p + reach_) / cell_));
  for (int x = low.x; x <= high.x; ++x) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int z = low.z; z <= high.z; ++z) {
        const auto found = cells_.find(Cell({x, y, z}));
        if (found == cells_.end()) continue;
        for (const std::uint32_t i : found->second) {
          // No place of a triangle lies nearer than its box; the margin is for rounding.
          const glm::vec3 off = glm::max(glm::max(low_[i] - p, p - high_[i]), 0.0f);
          if (glm::dot(off, off) > 1.001f * least + 1e-6f) continue;
          const auto& t = surface_.triangles[i];
          const glm::vec3 part =
              NearestPart(p, surface_.at[t[0]], surface_.at[t[1]], surface_.at[t[2]]);
          const auto mix = [&](const auto& v) {
            return v[t[0]] * part.x + v[t[1]] * part.y + v[t[2]] * part.z;
          };
          const glm::vec3 there = mix(surface_.at);
          const glm::vec3 d = there - p;
          float cost = glm::dot(d, d);
          if (cost >= least) continue;
          const float facing = glm::dot(normal, mix(surface_.normal));
          if (facing < kLeastFacing) continue;
          const float turned = kTurned * (1 - facing);
          const auto opposite = [](float a, float b) { return std::max(-a * b, 0.0f); };
          const float lip = kLip * opposite(other.lip[vertex], mix(surface_.lip));
          const float lid = kLid * opposite(other.lid[vertex], mix(surface_.lid));
          const float hidden = kHidden * (other.seen[vertex] - mix(surface_.seen));
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
