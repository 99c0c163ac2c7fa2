#include "face_fit/find/head/lip_seam.h"

#include <algorithm>

#include "face_fit/image/plane.h"
#include "face_fit/surface/visible_surface.h"
#include "fsm/mesh/transfer/surface_index.h"

namespace facefit {
namespace {

constexpr float kReachMm = 40;                       // greatest distance measured along the surface
constexpr float kMinWidthMm = 20, kMaxWidthMm = 90;  // widths of mouths
constexpr glm::vec2 kMarginMm(15, 3);                // margin of the window beside the lips

/// The rows where a column of the view crosses from the upper to the lower lip.
struct Crossing {
  int above, below;  ///< rows
  float jump_mm;     ///< jump of the distance along the surface
};

using Crossings = std::vector<std::optional<Crossing>>;

/// Returns the crossing of each column of the view that has one. `from_upper`, `from_lower`:
/// distance along the surface from either lip to each vertex.
Crossings FindCrossings(const VisibleSurface& view, const fsm::WeldedSurface& surface,
                        std::span<const float> from_upper, std::span<const float> from_lower) {
  // Distances at a point of the view if it shows skin, and not teeth or the mouth's lining.
  const auto distances = [&](int column, int row) -> std::optional<glm::vec2> {
    const SurfaceSample* sample = view.SampleAt(column, row);
    if (!sample || sample->triangle.material == fsm::Material::kMouthInside) return std::nullopt;
    const MeshPoint on_mesh = sample->OnMesh();
    glm::vec2 sum(0);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = surface.welded_of[on_mesh.corner[static_cast<std::size_t>(k)]];
      if (v == fsm::WeldedSurface::kNone) return std::nullopt;
      sum += on_mesh.weight[k] * glm::vec2(from_upper[v], from_lower[v]);
    }
    return sum;
  };
  Crossings crossings;
  for (int column = 0; column < view.grid().columns; ++column) {
    std::optional<Crossing> crossing;
    std::optional<glm::vec2> before;
    int row_before = -1;
    for (int row = view.grid().rows; row-- > 0;) {
      const auto here = distances(column, row);
      if (!here) continue;
      if (before && before->x < before->y && here->x >= here->y) {
        const float apart = kFrontStepMm * static_cast<float>(row_before - row);
        const float jump = std::min(here->x - before->x, before->y - here->y) - apart;
        if (jump > (crossing ? crossing->jump_mm : 0)) crossing = {row_before, row, jump};
      }
      before = here;
      row_before = row;
    }
    crossings.push_back(crossing);
  }
  return crossings;
}

/// Returns the first and last column of the mouth, the longest run of columns with a jump (near a
/// corner the way round is short, and jumps end there); nothing if there is none.
std::optional<Columns> MouthColumns(const Crossings& crossings) {
  constexpr float kMinJumpMm = 2;
  constexpr int kHole = 8;  // columns
  std::optional<Columns> longest;
  int begin = -1, end = -1;
  for (int column = 0; column < static_cast<int>(crossings.size()); ++column) {
    const auto& crossing = crossings[static_cast<std::size_t>(column)];
    if (!crossing || crossing->jump_mm < kMinJumpMm) continue;
    if (begin < 0 || column - end > kHole) begin = column;
    end = column;
    if (!longest || end - begin > longest->last - longest->first) longest = {begin, end};
  }
  return longest;
}

}  // namespace

std::optional<LipSeam> FindLipSeam(const fsm::HeadSurface& mesh,
                                   const std::vector<glm::vec3>& position,
                                   const std::vector<std::uint32_t>& skin_triangles,
                                   bool has_uv_seams, std::span<const glm::vec3> upper,
                                   std::span<const glm::vec3> lower) {
  if (upper.empty() || lower.empty() || skin_triangles.empty()) return std::nullopt;
  const fsm::WeldedSurface surface(position, skin_triangles, has_uv_seams);
  Box2 lips;
  for (const auto& list : {upper, lower}) {
    for (const glm::vec3& p : list) lips.Add(p);
  }
  const VisibleSurface view =
      VisibleFromFront(mesh, position, lips.low - kMarginMm, lips.high + kMarginMm);
  const auto crossings = FindCrossings(view, surface, surface.DistancesFrom(upper, kReachMm),
                                       surface.DistancesFrom(lower, kReachMm));
  const auto mouth = MouthColumns(crossings);
  if (!mouth) return std::nullopt;
  const float width = kFrontStepMm * static_cast<float>(mouth->last - mouth->first);
  if (width < kMinWidthMm || width > kMaxWidthMm) return std::nullopt;
  LipSeam seam;
  for (int column = mouth->first; column <= mouth->last; ++column) {
    // A column without a crossing uses the next one's.
    int next = column;
    while (!crossings[static_cast<std::size_t>(next)]) ++next;
    const Crossing& crossing = *crossings[static_cast<std::size_t>(next)];
    seam.columns.push_back({view.SampleAt(next, crossing.above)->OnMesh(),
                            view.SampleAt(next, crossing.below)->OnMesh()});
  }
  return seam;
}

}  // namespace facefit
