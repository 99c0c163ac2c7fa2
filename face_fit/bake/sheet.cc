#include "face_fit/bake/sheet.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/bake/head_atlas.h"
#include "face_fit/bake/sheet_depth.h"
#include "face_fit/bake/skin_surface.h"
#include "face_fit/bake/skin_texels.h"
#include "face_fit/fit/pixel_warp.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

// Numbers of the sheet's method; those tuned by eye are in tables/photo_look.txt.
constexpr float kMaxDepthMm = 60;   // camera's frame; no point of the sheet lies before the face
constexpr float kMinCellMm = 4.5F;  // between points of the sheet
constexpr float kMaxPoints = 14000;
constexpr float kWholeWithin = 0.999F;  // share of skin around a point above which it is never seen
constexpr float kBehindHoleMm = 90;     // farther back lies the hair at the nape
constexpr fsm::Range kFadeMotion{0, 0.3F};  // share of skin around a point over which motion begins

/// Extends motion beyond the covered points: the mean of those nearby, fading out.
VectorImage SpreadMotion(const VectorImage& motion, const Mask& covered, int reach) {
  const WeightedBlur nearby(motion, covered, reach);
  VectorImage out = motion;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = nearby.MeanAt(i) * kFadeMotion.Ramp(nearby.weight[i]);
  }
  return out;
}

/// Returns for each vertex of the base head its motion from the photo's expression to rest.
std::vector<glm::vec3> MotionToRest(const FittedHead& fitted) {
  const std::vector<glm::vec3> rest = SkinWith(fitted, {});
  std::vector<glm::vec3> motion(fitted.vertices.size(), glm::vec3(0));
  assert(rest.size() <= motion.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    motion[i] = rest[i] - fitted.vertices[i];
  }
  return motion;
}

/// Returns the vertices' motion at the visible points of a surface; 0 where there is none.
VectorImage MotionOn(const VisibleSurface& surface, const std::vector<glm::vec3>& motion) {
  return VectorImage::From(surface.grid().columns, surface.grid().rows, [&](int x, int y) {
    const SurfaceSample* sample = surface.SampleAt(x, y);
    return sample ? sample->OnMesh().On(motion) : glm::vec3(0);
  });
}

/// The holes of the sheet: no part of it may lie behind eyes and mouth. In a turned head one eye
/// and one corner of the mouth are near the edge of the visible skin, where the sheet continues
/// just below it.
class SheetHoles {
 public:
  explicit SheetHoles(const FittedHead& fitted) {
    using namespace point;
    constexpr std::array<std::pair<PointIndex, PointIndex>, 2> kEyes = {
        std::pair(kEyeOuterRight, kEyeInnerRight), std::pair(kEyeInnerLeft, kEyeOuterLeft)};
    const auto& look = PhotoLook().sheet_hole;
    for (std::size_t i = 0; i < kEyes.size(); ++i) {
      const glm::vec3 right = fitted.PositionOf(kEyes[i].first),
                      left = fitted.PositionOf(kEyes[i].second);
      const float half = 0.5F * std::abs(left.x - right.x) + look.beyond_eye_mm;
      eyes_[i] = {0.5F * (left + right), half, half, half};
    }
    const glm::vec3 right = fitted.PositionOf(kInnerMouthRight),
                    left = fitted.PositionOf(kInnerMouthLeft);
    mouth_ = {0.5F * (left + right), 0.5F * std::abs(left.x - right.x) + look.beyond_mouth_mm,
              look.above_mouth_mm, look.below_mouth_mm};
  }
  /// `p`: head's frame.
  bool IsBehindMouth(glm::vec3 p) const { return IsBehind(mouth_, p); }
  bool IsBehind(glm::vec3 p) const {
    return IsBehindMouth(p) ||
           std::ranges::any_of(eyes_, [p](const Oval& oval) { return IsBehind(oval, p); });
  }

 private:
  struct Oval {
    glm::vec3 middle{0};
    float half = 1, above = 1, below = 1;
  };
  static bool IsBehind(const Oval& oval, glm::vec3 p) {
    if (p.z < oval.middle.z - kBehindHoleMm) return false;
    const glm::vec2 from_middle = glm::vec2(p - oval.middle);
    const glm::vec2 radii =
        from_middle / glm::vec2(oval.half, from_middle.y > 0 ? oval.above : oval.below);
    return glm::dot(radii, radii) < 1;
  }
  std::array<Oval, 2> eyes_;
  Oval mouth_;
};

/// Returns the grid of the sheet, over the whole figure.
SampleGrid GridOver(const FigureCutout& figure, float pixels_per_mm) {
  const glm::vec2 extent(figure.colours.width, figure.colours.height);
  const float cell =
      std::max(kMinCellMm * pixels_per_mm, std::sqrt(extent.x * extent.y / kMaxPoints));
  return {
      {0, 0}, cell, static_cast<int>(extent.x / cell) + 2, static_cast<int>(extent.y / cell) + 2};
}

/// Corners of a cell, as offsets from its upper left point, counter-clockwise.
constexpr std::array<glm::ivec2, 4> kCellCorners = {{{0, 0}, {0, 1}, {1, 1}, {1, 0}}};

/// Selects the cells of the sheet to draw: those of the figure that are not hidden.
class DrawnCells {
 public:
  DrawnCells(const FittedHead& fitted, const CameraPose& pose, const SampleGrid& grid,
             const Mask& shown, const SkinOnGrid& skin, const FloatImage& depth)
      : pose_(pose),
        grid_(grid),
        shown_(shown),
        depth_(depth),
        holes_(fitted),
        within_(Blurred(WithoutHoles(skin.covered), skin.rim)) {}
  bool Has(glm::ivec2 cell) const {
    const auto hidden = [&](glm::ivec2 corner) { return IsHidden(cell + corner); };
    return IsShown(cell) && !std::ranges::all_of(kCellCorners, hidden) && !IsInMouth(cell);
  }

 private:
  static Mask WithoutHoles(Mask covered) {
    FillHoles(covered);
    return covered;
  }
  glm::vec3 PositionOf(glm::ivec2 p) const {
    return pose_.PositionOf(grid_.Point(p.x, p.y), depth_(p.x, p.y));
  }
  /// Returns whether the figure is visible at the cell's corners or at points next to them.
  bool IsShown(glm::ivec2 cell) const {
    for (int y = std::max(cell.y - 1, 0); y <= std::min(cell.y + 2, shown_.height - 1); ++y) {
      for (int x = std::max(cell.x - 1, 0); x <= std::min(cell.x + 2, shown_.width - 1); ++x) {
        if (shown_(x, y) > 0) return true;
      }
    }
    return false;
  }
  /// Returns whether a point is behind the middle of the face or in a hole.
  bool IsHidden(glm::ivec2 p) const {
    return within_(p.x, p.y) > kWholeWithin || holes_.IsBehind(PositionOf(p));
  }
  /// A cell of a small photo may be wider than the skin between lips and cheek.
  bool IsInMouth(glm::ivec2 cell) const {
    const auto corners = std::ranges::count_if(kCellCorners, [&](glm::ivec2 corner) {
      return holes_.IsBehindMouth(PositionOf(cell + corner));
    });
    return corners >= 2;
  }

  const CameraPose& pose_;
  const SampleGrid& grid_;
  const Mask& shown_;
  const FloatImage& depth_;
  SheetHoles holes_;
  Mask within_;  // share of face around each point, 0..1
};

/// Returns the points of the sheet, row by row. `motion`: of each to rest; `size`: of the figure,
/// pixels.
std::vector<fsm::PhotoHead::SheetVertex> SheetVertices(const CameraPose& pose,
                                                       const SampleGrid& grid,
                                                       const FloatImage& depth,
                                                       const VectorImage& motion, glm::vec2 size) {
  std::vector<fsm::PhotoHead::SheetVertex> vertices;
  ForEachPixel(grid.columns, grid.rows, [&](int x, int y, std::size_t i) {
    const glm::vec2 pixel = grid.Point(x, y);
    const glm::vec3 position = pose.PositionOf(pixel, std::min(depth[i], kMaxDepthMm));
    vertices.push_back({position + motion[i], OnFigureHalf(pixel / size)});
  });
  return vertices;
}

/// A cell of the sheet: its corners, counter-clockwise.
using Quad = std::array<std::uint32_t, 4>;

std::vector<Quad> DrawnQuads(const DrawnCells& cells, const FloatImage& depth) {
  std::vector<Quad> quads;
  for (int y = 0; y + 1 < depth.height; ++y) {
    for (int x = 0; x + 1 < depth.width; ++x) {
      if (!cells.Has({x, y})) continue;
      std::ranges::transform(kCellCorners, quads.emplace_back().begin(), [&](glm::ivec2 corner) {
        return static_cast<std::uint32_t>(depth.Index(x + corner.x, y + corner.y));
      });
    }
  }
  return quads;
}

/// Returns the quads as triangles, from back to front, because soft edges show what lies behind
/// them.
std::vector<std::uint32_t> BackToFront(std::vector<Quad> quads,
                                       const std::vector<fsm::PhotoHead::SheetVertex>& vertices) {
  std::ranges::sort(quads, {}, [&](const Quad& quad) {
    return std::pair(vertices[quad[0]].position.z + vertices[quad[2]].position.z, quad);
  });
  std::vector<std::uint32_t> triangles;
  for (const Quad& quad : quads) {
    for (const std::size_t k : {0U, 1U, 2U, 0U, 2U, 3U}) triangles.push_back(quad[k]);
  }
  return triangles;
}

}  // namespace

Sheet MakeSheet(const FittedHead& fitted, const CameraPose& pose, const FigureCutout& figure) {
  const float pixels_per_mm = pose.PixelsPerMm();
  const Chin chin(fitted);
  const SampleGrid grid = GridOver(figure, pixels_per_mm);
  const VisibleSurface surface = VisibleSkin(fitted, pose, grid, chin.SkinBottom());
  const SkinOnGrid skin(surface, MmToPixels(PhotoLook().sheet.rim_mm, pixels_per_mm / grid.step));
  // Hair and neck beside the skin move with it.
  const VectorImage motion =
      SpreadMotion(MotionOn(surface, MotionToRest(fitted)), skin.covered, skin.rim);
  const auto shown = Mask::From(grid.columns, grid.rows, [&](int x, int y) {
    const glm::vec2 pixel = grid.Point(x, y);
    return figure.opacity.SampleAt(pixel.x, pixel.y);
  });
  const FloatImage depth = SheetDepth(pose, grid, chin, skin, Blurred(shown, 2));
  auto vertices =
      SheetVertices(pose, grid, depth, motion, {figure.colours.width, figure.colours.height});
  auto triangles =
      BackToFront(DrawnQuads(DrawnCells(fitted, pose, grid, shown, skin, depth), depth), vertices);
  return {std::move(vertices), std::move(triangles), chin.SkinBottom()};
}

}  // namespace facefit
