#include "fsm/render/draw_order.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <tuple>
#include <utility>

namespace fsm {
namespace {

/// Tells whether a triangle is opaque. `cut_out`: it is discarded where the photo is transparent.
bool HidesAll(const HeadSurface& surface, std::span<const std::uint32_t> triangle, bool cut_out) {
  glm::vec2 low(1e9f), high(-1e9f);
  for (const std::uint32_t v : triangle) {
    if (surface.opacity[v] < 1) return false;
    low = glm::min(low, surface.textures.texcoord[v]);
    high = glm::max(high, surface.textures.texcoord[v]);
  }
  if (!cut_out) return true;
  const Image& texture = *surface.textures.base_colour;
  const glm::ivec2 last(texture.width - 1, texture.height - 1);
  const glm::vec2 size(texture.width, texture.height);
  // Coordinates of a file may be anything, also no numbers: those count as 1.
  const auto texel = [&size](glm::vec2 uv) {
    return glm::ivec2(glm::max(glm::vec2(0), glm::min(glm::vec2(1), uv)) * size);
  };
  const auto from = glm::clamp(texel(low) - 1, glm::ivec2(0), last);
  const auto to = glm::clamp(texel(high) + 1, glm::ivec2(0), last);
  for (int y = from.y; y <= to.y; ++y) {
    for (int x = from.x; x <= to.x; ++x) {
      if (texture.rgba[4 * texture.Index(x, y) + 3] < 250) return false;
    }
  }
  return true;
}

using Corners = std::span<const std::uint32_t>;

class OrderMaker {
 public:
  OrderMaker(const HeadSurface& surface, const HeadTriangles& triangles,
             std::span<const SkinDetail> detail)
      : surface_(surface), triangles_(triangles), detail_(detail) {}

  DrawOrder Make(std::span<const glm::vec3> rest) {
    const SortedHair hair = SortHair(rest);
    const HeadSurface::Part locks{.material = Material::kHair, .first_index = 0, .index_count = 0};
    Add(locks, hair.before);
    Layer sheet, skin;
    AddFace(sheet, skin);
    Add(sheet.part, sheet.corners, true);
    Add(skin.part, skin.corners, true);
    for (const auto& part : triangles_.parts) {
      if (part.material == Material::kShutLash) Add(part, CornersOf(part), true);
    }
    Add(locks, hair.behind);
    return std::move(order_);
  }

 private:
  /// Triangles that are blended with what lies behind them.
  struct Layer {
    HeadSurface::Part part{};
    std::vector<std::uint32_t> corners;
  };

  Corners CornersOf(const HeadSurface::Part& part) const {
    return Corners(triangles_.indices).subspan(part.first_index, part.index_count);
  }

  void Add(HeadSurface::Part part, Corners corners, bool blended = false,
           SkinDetail detail = SkinDetail::kDetailed) {
    if (corners.empty()) return;
    part.first_index = static_cast<std::uint32_t>(order_.indices.size());
    part.index_count = static_cast<std::uint32_t>(corners.size());
    order_.parts.push_back({part, blended, detail});
    order_.indices.insert(order_.indices.end(), corners.begin(), corners.end());
  }

  void AddByDetail(const HeadSurface::Part& part, Corners corners) {
    std::array<std::vector<std::uint32_t>, 3> lists;  // by SkinDetail
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3) {
      const auto t = corners.subspan(k, 3);
      SkinDetail detail = std::max({detail_[t[0]], detail_[t[1]], detail_[t[2]]});
      // The sheet shows what surrounds the face, which does not crease.
      if (detail == SkinDetail::kCreased && part.material == Material::kTextured) {
        detail = SkinDetail::kPlain;
      }
      auto& list = lists[static_cast<std::size_t>(detail)];
      list.insert(list.end(), t.begin(), t.end());
    }
    for (std::size_t k = 0; k < lists.size(); ++k) {
      Add(part, lists[k], false, static_cast<SkinDetail>(k));
    }
  }

  /// Adds all parts but hair and lashes; blended triangles go to the layers instead.
  void AddFace(Layer& sheet, Layer& skin) {
    for (const auto& part : triangles_.parts) {
      if (part.material == Material::kHair || part.material == Material::kShutLash) continue;
      const Corners corners = CornersOf(part);
      const bool of_skin = part.material == Material::kSkin;
      const bool of_sheet = part.material == Material::kTextured;
      if (HasBlendedLayers(surface_) && (of_skin || of_sheet)) {
        Layer& layer = of_sheet ? sheet : skin;
        layer.part = part;
        std::vector<std::uint32_t> whole;
        for (std::size_t k = 0; k + 2 < corners.size(); k += 3) {
          const auto t = corners.subspan(k, 3);
          auto& list = HidesAll(surface_, t, of_sheet) ? whole : layer.corners;
          list.insert(list.end(), t.begin(), t.end());
        }
        AddByDetail(part, whole);
      } else if (part.pbr < 0 && (of_skin || part.material == Material::kLip)) {
        AddByDetail(part, corners);
      } else {
        Add(part, corners);
      }
    }
  }

  /// Hair before and behind the ears, front to back.
  struct SortedHair {
    std::vector<std::uint32_t> before, behind;
  };
  /// Locks come before the shell of hair they lie on; ties are sorted by vertex index, so
  /// that the order is the same everywhere.
  SortedHair SortHair(std::span<const glm::vec3> rest) const {
    constexpr float kBehind = 0.0f;  // z of the plane of the ears
    using Triangle = std::array<std::uint32_t, 3>;
    std::vector<Triangle> hair;
    for (const auto& part : triangles_.parts) {
      if (part.material != Material::kHair) continue;
      const Corners corners = CornersOf(part);
      for (std::size_t k = 0; k < corners.size(); k += 3) {
        hair.push_back({corners[k], corners[k + 1], corners[k + 2]});
      }
    }
    const auto depth = [&rest](const Triangle& t) {
      return rest[t[0]].z + rest[t[1]].z + rest[t[2]].z;
    };
    const auto is_shell = [this](const Triangle& t) {
      return std::ranges::all_of(t, [this](std::uint32_t i) {
        return i >= surface_.strands.size() || surface_.strands[i].across == 0;
      });
    };
    std::ranges::sort(hair, {}, [&](const Triangle& t) {
      return std::tuple(depth(t) < kBehind, is_shell(t), -depth(t), t);
    });
    SortedHair sorted;
    for (const Triangle& t : hair) {
      auto& corners = depth(t) < kBehind ? sorted.behind : sorted.before;
      corners.insert(corners.end(), t.begin(), t.end());
    }
    return sorted;
  }

  const HeadSurface& surface_;
  const HeadTriangles& triangles_;
  const std::span<const SkinDetail> detail_;
  DrawOrder order_;
};

}  // namespace

DrawOrder OrderToDraw(const HeadSurface& surface, const HeadTriangles& triangles,
                      std::span<const glm::vec3> rest, std::span<const SkinDetail> detail) {
  return OrderMaker(surface, triangles, detail).Make(rest);
}

}  // namespace fsm
