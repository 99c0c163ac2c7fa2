#include "face_fit/find/head/lid_edges.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/find/head/front_view.h"
#include "fsm/mesh/transferred_rig.h"

namespace facefit {
namespace {

/// Half the window looked at, millimetres.
constexpr glm::vec2 kHalf(34, 24);

/// The cells in which an eyeball is foremost, of those connected with the one nearest to `centre`.
std::vector<bool> Opening(const FrontView& view, const std::vector<bool>& is_eye,
                          glm::vec2 centre) {
  const auto at = [&view](int column, int row) {
    return static_cast<std::size_t>(row * view.columns() + column);
  };
  std::vector<bool> open(is_eye.size(), false);
  std::vector<std::pair<int, int>> todo;
  float nearest = 12;
  for (int row = 0; row < view.rows(); ++row) {
    for (int column = 0; column < view.columns(); ++column) {
      const float far = glm::distance(view.Centre(column, row), centre);
      if (!is_eye[at(column, row)] || far >= nearest) continue;
      nearest = far;
      todo.assign(1, {column, row});
    }
  }
  while (!todo.empty()) {
    const auto [column, row] = todo.back();
    todo.pop_back();
    if (column < 0 || row < 0 || column >= view.columns() || row >= view.rows()) continue;
    if (open[at(column, row)] || !is_eye[at(column, row)]) continue;
    open[at(column, row)] = true;
    for (const auto& [x, y] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
      todo.emplace_back(column + x, row + y);
    }
  }
  return open;
}

/// The rows of a column in which an opening lies.
struct RowSpan {
  int low, high;
  bool IsEmpty() const { return high < low; }
};
std::vector<RowSpan> RowsOf(const FrontView& view, const std::vector<bool>& open) {
  std::vector<RowSpan> rows(static_cast<std::size_t>(view.columns()), {view.rows(), -1});
  for (int row = 0; row < view.rows(); ++row) {
    for (int column = 0; column < view.columns(); ++column) {
      if (!open[static_cast<std::size_t>(row * view.columns() + column)]) continue;
      RowSpan& span = rows[static_cast<std::size_t>(column)];
      span.low = std::min(span.low, row);
      span.high = row;
    }
  }
  return rows;
}

/// The first and the last column of an opening; nothing if that is not as wide as eyes are.
struct Columns {
  int first, last;
};
std::optional<Columns> EndsOf(const std::vector<RowSpan>& rows) {
  constexpr float kNarrowest = 10, kWidest = 60;  // millimetres
  const auto first = std::ranges::find_if_not(rows, &RowSpan::IsEmpty);
  auto end = rows.end();
  while (end != first && (end - 1)->IsEmpty()) --end;
  const float width = FrontView::kCell * static_cast<float>(end - first);
  if (width < kNarrowest || width > kWidest) return std::nullopt;
  return Columns{static_cast<int>(first - rows.begin()), static_cast<int>(end - rows.begin()) - 1};
}

}  // namespace

std::optional<LidEdges> FindLidEdges(const fsm::HeadTopology& topology,
                                     std::span<const glm::vec3> position,
                                     const std::vector<bool>& eye, glm::vec3 centre,
                                     float outward) {
  const FrontView view(topology, position, glm::vec2(centre) - kHalf, glm::vec2(centre) + kHalf);
  const auto is_eye = [&](int column, int row) {
    const std::uint32_t k = view.Triangle(column, row);
    return k != FrontView::kNone && eye[topology.indices[k]];
  };
  std::vector<bool> eyes;
  for (int row = 0; row < view.rows(); ++row) {
    for (int column = 0; column < view.columns(); ++column) eyes.push_back(is_eye(column, row));
  }
  const std::vector<RowSpan> rows = RowsOf(view, Opening(view, eyes, centre));
  const auto ends = EndsOf(rows);
  if (!ends) return std::nullopt;
  // A cell or two of gap between eyeball and lid may show what lies behind.
  constexpr int kGap = 8;
  const auto beyond = [&](int column, int row, int right, int up) -> std::optional<MeshPoint> {
    for (int k = 1; k <= kGap; ++k) {
      const int x = column + k * right, y = row + k * up;
      if (view.Triangle(x, y) != FrontView::kNone && !is_eye(x, y)) return view.Place(x, y);
    }
    return std::nullopt;
  };
  const auto corner = [&](int column, int right) {
    const RowSpan& span = rows[static_cast<std::size_t>(column)];
    return beyond(column, (span.low + span.high) / 2, right, 0);
  };
  LidEdges edges;
  const int out = outward > 0 ? ends->last : ends->first;
  const int in = outward > 0 ? ends->first : ends->last;
  const auto outer = corner(out, outward > 0 ? 1 : -1), inner = corner(in, outward > 0 ? -1 : 1);
  if (!outer || !inner) return std::nullopt;
  edges.outer = *outer;
  edges.inner = *inner;
  for (std::size_t k = 0; k < LidEdges::kBetween; ++k) {
    const float part = static_cast<float>(k + 1) / (LidEdges::kBetween + 1);
    const int column = static_cast<int>(
        std::lround(static_cast<float>(out) + part * static_cast<float>(in - out)));
    const RowSpan& span = rows[static_cast<std::size_t>(column)];
    const auto upper = beyond(column, span.high, 0, 1), lower = beyond(column, span.low, 0, -1);
    if (span.IsEmpty() || !upper || !lower) return std::nullopt;
    edges.upper[k] = *upper;
    edges.lower[k] = *lower;
  }
  return edges;
}

std::vector<bool> EyeVertices(const fsm::HeadTopology& topology, std::size_t count) {
  std::vector<bool> eye(count, false);
  for (const std::uint32_t v : fsm::EyeballTriangles(topology)) eye[v] = true;
  return eye;
}

void OntoLidEdges(const EyeSurface& ours, std::vector<MeshPoint>& our_places,
                  const EyeSurface& theirs, std::vector<MeshPoint>& their_places) {
  for (const fsm::Side side : fsm::kSides) {
    const auto find = [side](const EyeSurface& surface) {
      const auto& topology = surface.head.head->topology();
      return FindLidEdges(topology, surface.head.rest.position, surface.eye,
                          topology.eyes[side].centre, fsm::SignOf(side));
    };
    const auto a = find(ours), b = find(theirs);
    if (!a || !b) continue;
    const auto outline = EyeOutline(side);
    for (const auto& [edges, places] : {std::pair(&*a, &our_places), {&*b, &their_places}}) {
      const auto put = [&, list = places](std::size_t of_outline, const MeshPoint& place) {
        (*list)[outline[of_outline]] = place;
      };
      put(kOuterCorner, edges->outer);
      put(kInnerCorner, edges->inner);
      for (std::size_t k = 0; k < LidEdges::kBetween; ++k) {
        put(1 + k, edges->upper[k]);
        put(outline.size() - 1 - k, edges->lower[k]);
      }
    }
  }
}

}  // namespace facefit
