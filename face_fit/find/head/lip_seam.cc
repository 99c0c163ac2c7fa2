#include "face_fit/find/head/lip_seam.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "face_fit/find/head/front_view.h"
#include "face_fit/picture/pixels.h"
#include "fsm/mesh/surface_index.h"

namespace facefit {
namespace {

constexpr float kReach = 40;                        // of ways along the surface, millimetres
constexpr float kLeastWidth = 20, kMostWidth = 90;  // of a mouth, millimetres

/// Where a column of the view goes over from the upper lip to the lower.
struct Crossing {
  int above = -1, below = -1;  ///< rows
  float jump = 0;              ///< of the way from the upper lip, millimetres
};

/// Whether the triangle that begins at `index` lines the mouth.
bool IsInside(const fsm::HeadTopology& topology, std::uint32_t index) {
  return std::ranges::any_of(topology.parts, [index](const auto& part) {
    return part.material == fsm::Material::kMouthInside && index >= part.first_index &&
           index < part.first_index + part.index_count;
  });
}

/// For each column of the view the row where the surface goes over from the upper to the lower lip.
/// `up`, `down`: ways along the surface from both lips to each of its places, millimetres.
std::vector<Crossing> FindCrossings(const fsm::HeadTopology& topology, const FrontView& view,
                                    const fsm::WeldedSurface& surface, std::span<const float> up,
                                    std::span<const float> down) {
  // The distances of a cell's skin from both lips; nothing where teeth or the mouth's lining are.
  const auto ways = [&](int column, int row) -> std::optional<glm::vec2> {
    const std::uint32_t triangle = view.Triangle(column, row);
    if (triangle == FrontView::kNone || IsInside(topology, triangle)) return std::nullopt;
    const MeshPoint place = view.Place(column, row);
    glm::vec2 sum(0);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = surface.of[place.corner[static_cast<std::size_t>(k)]];
      if (v == fsm::WeldedSurface::kNone) return std::nullopt;
      sum += place.part[k] * glm::vec2(up[v], down[v]);
    }
    return sum;
  };
  std::vector<Crossing> crossings;
  for (int column = 0; column < view.columns(); ++column) {
    Crossing crossing;
    std::optional<glm::vec2> before;
    int row_before = -1;
    for (int row = view.rows(); row-- > 0;) {
      const auto here = ways(column, row);
      if (!here) continue;
      if (before && before->x < before->y && here->x >= here->y) {
        const float apart = FrontView::kCell * static_cast<float>(row_before - row);
        const float jump = std::min(here->x - before->x, before->y - here->y) - apart;
        if (jump > crossing.jump) crossing = {row_before, row, jump};
      }
      before = here;
      row_before = row;
    }
    crossings.push_back(crossing);
  }
  return crossings;
}

/// First and last column of the mouth, the longest run of columns whose surface jumps: near a
/// corner the way round it is short, and the jump ends there. (0, -1) if there is none.
std::pair<int, int> MouthColumns(const std::vector<Crossing>& crossings) {
  constexpr float kLeastJump = 2;  // millimetres
  constexpr int kHole = 8;         // columns
  int first = 0, last = -1, begin = -1, end = -1;
  for (int column = 0; column < static_cast<int>(crossings.size()); ++column) {
    if (crossings[static_cast<std::size_t>(column)].jump < kLeastJump) continue;
    if (begin < 0 || column - end > kHole) begin = column;
    end = column;
    if (end - begin > last - first) {
      first = begin;
      last = end;
    }
  }
  return {first, last};
}

}  // namespace

std::optional<LipSeam> FindLipSeam(const fsm::HeadTopology& topology,
                                   std::span<const glm::vec3> position,
                                   const std::vector<std::uint32_t>& skin_triangles,
                                   bool has_uv_seams, std::span<const glm::vec3> upper,
                                   std::span<const glm::vec3> lower) {
  if (upper.empty() || lower.empty()) return std::nullopt;
  const fsm::WeldedSurface surface(position, skin_triangles, has_uv_seams);
  Box2 lips;
  for (const auto& list : {upper, lower}) {
    for (const glm::vec3& p : list) lips.Add(p);
  }
  const glm::vec2 margin(15, 3);  // millimetres
  const FrontView view(topology, position, lips.low - margin, lips.high + margin);
  const auto crossings =
      FindCrossings(topology, view, surface, surface.DistancesFrom(upper, kReach),
                    surface.DistancesFrom(lower, kReach));
  const std::pair<int, int> columns = MouthColumns(crossings);
  const int first = columns.first, last = columns.second;
  const float width = FrontView::kCell * static_cast<float>(last - first);
  if (width < kLeastWidth || width > kMostWidth) return std::nullopt;
  const auto crossing_at = [&](float part) {
    int column = static_cast<int>(
        std::lround(static_cast<float>(first) + part * static_cast<float>(last - first)));
    while (column < last && crossings[static_cast<std::size_t>(column)].above < 0) ++column;
    return std::pair(column, crossings[static_cast<std::size_t>(column)]);
  };
  LipSeam seam;
  const auto [c0, s0] = crossing_at(0);
  const auto [c1, s1] = crossing_at(1);
  seam.right = view.Place(c0, s0.above);
  seam.left = view.Place(c1, s1.above);
  for (std::size_t k = 0; k < LipSeam::kBetween; ++k) {
    const auto [column, crossing] =
        crossing_at(static_cast<float>(k + 1) / static_cast<float>(LipSeam::kBetween + 1));
    seam.upper[k] = view.Place(column, crossing.above);
    seam.lower[k] = view.Place(column, crossing.below);
  }
  return seam;
}

}  // namespace facefit
