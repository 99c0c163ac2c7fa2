#include "face_fit/find/lid_edges.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "face_fit/find/front_view.h"

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

}  // namespace

std::optional<LidEdges> FindLidEdges(const fsm::HeadTopology& topology,
                                     std::span<const glm::vec3> position,
                                     const std::vector<bool>& eye, glm::vec3 centre,
                                     float outward) {
  const FrontView view(topology, position, glm::vec2(centre) - kHalf, glm::vec2(centre) + kHalf);
  std::vector<bool> is_eye;
  for (int row = 0; row < view.rows(); ++row) {
    for (int column = 0; column < view.columns(); ++column) {
      const std::uint32_t k = view.Triangle(column, row);
      is_eye.push_back(k != FrontView::kNone && eye[topology.indices[k]]);
    }
  }
  const std::vector<bool> open = Opening(view, is_eye, centre);
  const auto at = [&view](int column, int row) {
    return static_cast<std::size_t>(row * view.columns() + column);
  };
  int first = view.columns(), last = -1;
  std::vector<std::pair<int, int>> span;
  for (int column = 0; column < view.columns(); ++column) {
    auto& [low, high] = span.emplace_back(view.rows(), -1);
    for (int row = 0; row < view.rows(); ++row) {
      if (!open[at(column, row)]) continue;
      low = std::min(low, row);
      high = row;
    }
    if (high < 0) continue;
    first = std::min(first, column);
    last = column;
  }
  const float width = FrontView::kCell * static_cast<float>(last - first + 1);
  if (last < 0 || width < 10 || width > 60) return std::nullopt;
  // A cell or two of gap between eyeball and lid may show what lies behind.
  constexpr int kGap = 8;
  const auto beyond = [&](int column, int row, int right, int up) -> std::optional<MeshPlace> {
    for (int k = 1; k <= kGap; ++k) {
      const int x = column + k * right, y = row + k * up;
      if (view.Triangle(x, y) != FrontView::kNone && !is_eye[at(x, y)]) return view.Place(x, y);
    }
    return std::nullopt;
  };
  const auto corner = [&](int column, int right) {
    const auto& [low, high] = span[static_cast<std::size_t>(column)];
    return beyond(column, (low + high) / 2, right, 0);
  };
  LidEdges edges;
  const int out = outward > 0 ? last : first, in = outward > 0 ? first : last;
  const auto outer = corner(out, outward > 0 ? 1 : -1), inner = corner(in, outward > 0 ? -1 : 1);
  if (!outer || !inner) return std::nullopt;
  edges.outer = *outer;
  edges.inner = *inner;
  for (std::size_t k = 0; k < LidEdges::kBetween; ++k) {
    const float part = static_cast<float>(k + 1) / (LidEdges::kBetween + 1);
    const int column = static_cast<int>(
        std::lround(static_cast<float>(out) + part * static_cast<float>(in - out)));
    const auto& [low, high] = span[static_cast<std::size_t>(column)];
    const auto upper = beyond(column, high, 0, 1), lower = beyond(column, low, 0, -1);
    if (high < 0 || !upper || !lower) return std::nullopt;
    edges.upper[k] = *upper;
    edges.lower[k] = *lower;
  }
  return edges;
}

std::vector<bool> EyeVertices(const fsm::HeadTopology& topology, std::size_t count) {
  std::vector<bool> eye(count, false);
  for (const auto& part : topology.parts) {
    if (part.material != fsm::Material::kSclera && part.material != fsm::Material::kIris &&
        part.material != fsm::Material::kPupil) {
      continue;
    }
    for (std::uint32_t k = 0; k < part.index_count; ++k) {
      eye[topology.indices[part.first_index + k]] = true;
    }
  }
  return eye;
}

void OntoLidEdges(const EyeSurface& ours, std::vector<MeshPlace>& our_places,
                  const EyeSurface& theirs, std::vector<MeshPlace>& their_places) {
  // Of the network's points: outer corner, upper lid, inner corner, lower lid; outer ones first.
  struct Outline {
    int outer, inner;
    std::array<int, LidEdges::kBetween> upper, lower;
  };
  constexpr Outline kOutlines[] = {
      {33, 133, {246, 161, 160, 159, 158, 157, 173}, {7, 163, 144, 145, 153, 154, 155}},
      {263, 362, {466, 388, 387, 386, 385, 384, 398}, {249, 390, 373, 374, 380, 381, 382}}};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto find = [side](const EyeSurface& surface) {
      const auto& topology = surface.head.head->topology();
      return FindLidEdges(topology, surface.head.rest.position, surface.eye,
                          topology.eyes[side].centre, side == 0 ? -1.0F : 1.0F);
    };
    const auto a = find(ours), b = find(theirs);
    if (!a || !b) continue;
    for (const auto& [edges, places] : {std::pair(&*a, &our_places), {&*b, &their_places}}) {
      const auto set = [&](int point, const MeshPlace& place) {
        (*places)[static_cast<std::size_t>(point)] = place;
      };
      set(kOutlines[side].outer, edges->outer);
      set(kOutlines[side].inner, edges->inner);
      for (std::size_t k = 0; k < LidEdges::kBetween; ++k) {
        set(kOutlines[side].upper[k], edges->upper[k]);
        set(kOutlines[side].lower[k], edges->lower[k]);
      }
    }
  }
}

}  // namespace facefit
