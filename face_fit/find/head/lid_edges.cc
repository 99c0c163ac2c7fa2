#include "face_fit/find/head/lid_edges.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/image/filters.h"
#include "face_fit/surface/visible_surface.h"
#include "fsm/mesh/rigging/transferred_rig.h"

namespace facefit {
namespace {

/// Half the size of the window that is searched.
constexpr glm::vec2 kHalfWindowMm(34, 24);

/// Returns 1 where an eyeball is foremost and connected to its point nearest to `centre`, else 0.
Mask EyeballMask(const VisibleSurface& surface, const std::vector<bool>& is_eye, glm::vec2 centre) {
  constexpr float kFarthestMm = 12;
  Mask eyeball(surface.grid().columns, surface.grid().rows);
  glm::ivec2 seed(0);
  float nearest = kFarthestMm;
  ForEachPixel(eyeball.width, eyeball.height, [&](int column, int row, std::size_t i) {
    const SurfaceSample* sample = surface.SampleAt(column, row);
    if (!sample || !is_eye[sample->triangle.corner[0]]) return;
    eyeball[i] = 1;
    const float distance = glm::distance(surface.grid().Point(column, row), centre);
    if (distance >= nearest) return;
    nearest = distance;
    seed = {column, row};
  });
  if (nearest == kFarthestMm) return Mask(eyeball.width, eyeball.height);
  KeepConnected(seed, eyeball);
  return eyeball;
}

/// The rows of the opening in one column.
struct RowSpan {
  int low, high;
  bool IsEmpty() const { return high < low; }
};
std::vector<RowSpan> RowsOf(const Mask& eyeball) {
  std::vector<RowSpan> rows(static_cast<std::size_t>(eyeball.width), {eyeball.height, -1});
  ForEachPixel(eyeball.width, eyeball.height, [&](int column, int row, std::size_t i) {
    if (eyeball[i] <= 0) return;
    RowSpan& span = rows[static_cast<std::size_t>(column)];
    span.low = std::min(span.low, row);
    span.high = row;
  });
  return rows;
}

/// Returns the first and the last column of an opening; nothing if its width is not an eye's.
std::optional<Columns> EndsOf(const std::vector<RowSpan>& rows) {
  constexpr float kNarrowestMm = 10, kWidestMm = 60;
  const auto first = std::ranges::find_if_not(rows, &RowSpan::IsEmpty);
  auto end = rows.end();
  while (end != first && (end - 1)->IsEmpty()) --end;
  const float width = kFrontStepMm * static_cast<float>(end - first);
  if (width < kNarrowestMm || width > kWidestMm) return std::nullopt;
  return Columns{static_cast<int>(first - rows.begin()), static_cast<int>(end - rows.begin()) - 1};
}

/// Walks from the opening of an eye to the flesh around it.
class OpeningWalker {
 public:
  /// `is_eye`: as for FindLidEdges. All outlive this object.
  OpeningWalker(const VisibleSurface& surface, const std::vector<bool>& is_eye,
                const std::vector<RowSpan>& rows)
      : surface_(surface), is_eye_(is_eye), rows_(rows) {}
  /// Returns the corner of the eye beside the last column of the opening to that side.
  std::optional<MeshPoint> CornerBeside(int column, int right) const {
    const RowSpan& span = RowsIn(column);
    return FleshBeyond(column, (span.low + span.high) / 2, right, 0);
  }
  std::optional<MeshPoint> UpperEdgeIn(int column) const {
    return RowsIn(column).IsEmpty() ? std::nullopt : FleshBeyond(column, RowsIn(column).high, 0, 1);
  }
  std::optional<MeshPoint> LowerEdgeIn(int column) const {
    return RowsIn(column).IsEmpty() ? std::nullopt : FleshBeyond(column, RowsIn(column).low, 0, -1);
  }

 private:
  const RowSpan& RowsIn(int column) const { return rows_[static_cast<std::size_t>(column)]; }
  std::optional<MeshPoint> FleshBeyond(int column, int row, int right, int up) const {
    // A gap of a few steps between eyeball and lid may show what lies behind.
    constexpr int kGap = 8;
    for (int k = 1; k <= kGap; ++k) {
      const SurfaceSample* sample = surface_.SampleAt(column + k * right, row + k * up);
      if (sample && !is_eye_[sample->triangle.corner[0]]) return sample->OnMesh();
    }
    return std::nullopt;
  }

  const VisibleSurface& surface_;
  const std::vector<bool>& is_eye_;
  const std::vector<RowSpan>& rows_;
};

}  // namespace

std::optional<LidEdges> FindLidEdges(const fsm::Head& head, const std::vector<glm::vec3>& position,
                                     const std::vector<bool>& is_eye, fsm::Side side) {
  const glm::vec2 centre(head.EyeCentre(side));
  const VisibleSurface surface =
      VisibleFromFront(head.surface(), position, centre - kHalfWindowMm, centre + kHalfWindowMm);
  const std::vector<RowSpan> rows = RowsOf(EyeballMask(surface, is_eye, centre));
  const auto ends = EndsOf(rows);
  if (!ends) return std::nullopt;
  const OpeningWalker walker(surface, is_eye, rows);
  // The agent's left is where x is positive.
  const bool left = side == fsm::Side::kLeft;
  const int out = left ? ends->last : ends->first, in = left ? ends->first : ends->last;
  const auto outer = walker.CornerBeside(out, left ? 1 : -1);
  const auto inner = walker.CornerBeside(in, left ? -1 : 1);
  if (!outer || !inner) return std::nullopt;
  LidEdges edges{*outer, *inner, {}, {}};
  for (std::size_t k = 0; k < LidEdges::kBetween; ++k) {
    const float along = static_cast<float>(k + 1) / (LidEdges::kBetween + 1);
    const int column = static_cast<int>(
        std::lround(static_cast<float>(out) + along * static_cast<float>(in - out)));
    const auto upper = walker.UpperEdgeIn(column), lower = walker.LowerEdgeIn(column);
    if (!upper || !lower) return std::nullopt;
    edges.upper[k] = *upper;
    edges.lower[k] = *lower;
  }
  return edges;
}

std::vector<bool> EyeVertices(const fsm::HeadSurface& surface) {
  std::vector<bool> is_eye(surface.albedo.size(), false);
  for (const std::uint32_t v : fsm::EyeballTriangles(surface)) is_eye[v] = true;
  return is_eye;
}

}  // namespace facefit
