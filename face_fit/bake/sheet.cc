#include "face_fit/bake/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/bake/skin_surface.h"
#include "face_fit/bake/skin_texels.h"
#include "face_fit/fit/landmark_warp.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/grain.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

// Numbers of the sheet that are not to be tuned by eye; the others are in tables/appearance.txt.
constexpr float kUsualDepth = 20;   // of what lies beside the face, camera's frame, millimetres
constexpr float kMostDepth = 60;    // of the sheet: no point of it stands before the face
constexpr float kLeastCell = 4.5F;  // millimetres between its points
constexpr float kMostPoints = 14000;
constexpr int kPoissonSteps = 400;
constexpr float kShownLeast = 0.12F;  // opacity below which a point lies outside the figure
constexpr float kDeepInside = 0.95F;  // of what is around: the skin there keeps its whole distance
constexpr float kWholeWithin = 0.999F;  // of what is around: there the sheet is never seen
constexpr float kToShoulders = 70;      // millimetres below the chin
constexpr float kBehindOpening = 90;    // millimetres; farther back there is the hair at the nape
// Over how much of what is around an edge fades.
constexpr glm::vec2 kFadeMotion{0, 0.3F}, kFadeDepth{0, 0.25F};

/// The chin of the fitted head, and what lies about it, in the head's frame.
class Chin {
 public:
  explicit Chin(const FittedHead& fitted) : at_(fitted.At(point::kChin)) {}
  glm::vec3 at() const { return at_; }
  /// Below it the neck of the photo takes over from the skin.
  float SkinBottom() const { return at_.y - PhotoLook()("skin_below_chin"); }
  /// 1 well below the chin, 0 above it.
  float Below(glm::vec3 p) const { return Ramp(at_.y + below_, p.y); }
  /// 1 below the chin, behind which the neck lies, 0 where the skin goes on to neck, ear and hair.
  float BeforeNeck(glm::vec3 p) const { return Below(p) * Ramp(before_neck_, std::abs(p.x)); }

 private:
  glm::vec3 at_;
  glm::vec2 below_ = PhotoLook().Pair("below_chin"), before_neck_ = PhotoLook().Pair("before_neck");
};

/// Fills what is not fixed with the solution of Poisson's equation for an even, slight curvature:
/// as a skin of soap would span it, but a little rounder. By Gauss and Seidel, not to the end.
void SolvePoisson(const FloatImage& fixed, FloatImage& depth) {
  const float round = PhotoLook()("sheet_round");
  for (int step = 0; step < kPoissonSteps; ++step) {
    for (int y = 0; y < depth.height; ++y) {
      for (int x = 0; x < depth.width; ++x) {
        const std::size_t i = depth.Index(x, y);
        if (fixed.at[i] > 0) continue;
        const auto next = [&](int dx, int dy) {
          return depth(std::clamp(x + dx, 0, depth.width - 1),
                       std::clamp(y + dy, 0, depth.height - 1));
        };
        depth.at[i] = 0.25F * (next(1, 0) + next(-1, 0) + next(0, 1) + next(0, -1)) + round;
      }
    }
  }
}

/// The mean of what is covered around each point, ever less beyond its edge.
VectorImage Spread(const VectorImage& motion, const FloatImage& covered, int reach) {
  const FloatImage share = Blurred(covered, reach);
  VectorImage out = Blurred(motion, reach);
  for (std::size_t i = 0; i < out.at.size(); ++i) {
    out.at[i] *= Ramp(kFadeMotion, share.at[i]) / std::max(share.at[i], 1e-3F);
  }
  return out;
}

/// How the skin moves from the photo's expression to rest, at each vertex of the base head.
std::vector<glm::vec3> MotionToRest(const FittedHead& fitted) {
  const std::vector<glm::vec3> rest = SkinWith(fitted, {});
  std::vector<glm::vec3> motion(fitted.posed_vertices.size(), glm::vec3(0));
  for (std::size_t i = 0; i < std::min(rest.size(), motion.size()); ++i) {
    motion[i] = rest[i] - fitted.posed_vertices[i];
  }
  return motion;
}

/// What moves each vertex, at the places of a surface; 0 where nothing is.
VectorImage MotionOn(const VisibleSurface& surface, const std::vector<glm::vec3>& motion) {
  return VectorImage::From(surface.grid().columns, surface.grid().rows, [&](int x, int y) {
    return surface.Triangle(x, y) ? surface.Place(x, y).On(motion) : glm::vec3(0);
  });
}

/// The eyes and the mouth, which open: no part of the sheet may lie behind them. Of a turned head
/// one eye and one corner of the mouth are near the edge of what the photo shows, where the sheet
/// goes on from just under the skin.
class HeadOpenings {
 public:
  explicit HeadOpenings(const FittedHead& fitted) {
    using namespace point;
    constexpr std::array<std::pair<PointIndex, PointIndex>, 2> kEyes = {
        std::pair(kEyeOuterRight, kEyeInnerRight), std::pair(kEyeInnerLeft, kEyeOuterLeft)};
    const glm::vec2 beyond = PhotoLook().Pair("opening_beyond_corner");
    const glm::vec2 mouth = PhotoLook().Pair("opening_mouth");
    for (std::size_t i = 0; i < kEyes.size(); ++i) {
      const glm::vec3 right = fitted.At(kEyes[i].first), left = fitted.At(kEyes[i].second);
      const float half = 0.5F * std::abs(left.x - right.x) + beyond.x;
      ovals_[i] = {0.5F * (left + right), half, half, half};
    }
    const glm::vec3 right = fitted.At(kInnerMouthRight), left = fitted.At(kInnerMouthLeft);
    ovals_[2] = {0.5F * (left + right), 0.5F * std::abs(left.x - right.x) + beyond.y, mouth.x,
                 mouth.y};
  }
  /// `p`: in the head's frame.
  bool BehindMouth(glm::vec3 p) const { return Behind(ovals_[2], p); }
  bool Behind(glm::vec3 p) const {
    return std::ranges::any_of(ovals_, [p](const Oval& oval) { return Behind(oval, p); });
  }

 private:
  struct Oval {
    glm::vec3 middle{0};
    float half = 1, above = 1, below = 1;
  };
  static bool Behind(const Oval& oval, glm::vec3 p) {
    if (p.z < oval.middle.z - kBehindOpening) return false;
    const glm::vec2 off = glm::vec2(p - oval.middle);
    const glm::vec2 part = off / glm::vec2(oval.half, off.y > 0 ? oval.above : oval.below);
    return glm::dot(part, part) < 1;
  }
  std::array<Oval, 3> ovals_{};
};

/// The grid of the sheet, over the whole figure.
SampleGrid GridOver(const Cutout& figure, float pixels_per_mm) {
  const glm::vec2 extent(figure.colours.width, figure.colours.height);
  const float cell =
      std::max(kLeastCell * pixels_per_mm, std::sqrt(extent.x * extent.y / kMostPoints));
  return {
      {0, 0}, cell, static_cast<int>(extent.x / cell) + 2, static_cast<int>(extent.y / cell) + 2};
}

/// The skin on the sheet's grid.
struct GridSkin {
  GridSkin(const VisibleSurface& surface, int rim_cells)
      : rim(rim_cells),
        depth(surface.depth()),
        covered(surface.Covered()),
        inner(depth.width, depth.height),
        within(Blurred(covered, rim)) {
    for (std::size_t i = 0; i < depth.at.size(); ++i) {
      inner.at[i] = covered.at[i] > 0 && within.at[i] > kEdge ? 1.0F : 0.0F;
    }
  }
  /// From here on skin is inner: at the very edge it turns away, and each point has a depth of its
  /// own.
  static constexpr float kEdge = 0.62F;
  int rim;             ///< cells
  FloatImage depth;    ///< towards the camera, millimetres
  FloatImage covered;  ///< 1 where there is skin
  FloatImage inner;    ///< 1 where it is inner skin
  FloatImage within;   ///< how much of what is nearer than the rim is skin, 0..1
};

/// Depth of the sheet, millimetres towards the camera: just under the skin, from there gently back
/// to the outline. `shown`: the figure's opacity, 0..1.
FloatImage SheetDepth(const FittedHead& fitted, const SampleGrid& grid, const Chin& chin,
                      const GridSkin& skin, const FloatImage& shown) {
  const fsm::NumberTable& look = PhotoLook();
  const glm::vec2 under_skin = look.Pair("sheet_under_skin");
  const glm::vec2 before_neck = look.Pair("sheet_at_neck");
  const float turns = look("sheet_turns");
  FloatImage depth(grid.columns, grid.rows), fixed(depth), beside(skin.depth);
  for (std::size_t i = 0; i < beside.at.size(); ++i) beside.at[i] *= skin.inner.at[i];
  beside = Blurred(beside, skin.rim);
  const FloatImage share = Blurred(skin.inner, skin.rim);
  for (int y = 0; y < grid.rows; ++y) {
    for (int x = 0; x < grid.columns; ++x) {
      const std::size_t i = depth.Index(x, y);
      const glm::vec3 about = fitted.pose.PlaceAt(grid.Point(x, y), kUsualDepth);
      if (skin.inner.at[i] > 0) {
        fixed.at[i] = 1;
        // At the skin's edge the sheet goes on from it, further in it keeps out of its way.
        const float inward = glm::smoothstep(GridSkin::kEdge, kDeepInside, skin.within.at[i]);
        const float under = skin.depth.at[i] - glm::mix(under_skin.x, under_skin.y, inward);
        // Behind the lower face lies the neck; the jaw has room to open.
        depth.at[i] = glm::mix(under, std::min(under, before_neck.x), chin.BeforeNeck(about)) -
                      before_neck.y * chin.Below(about);
      } else if (skin.covered.at[i] <= 0 && shown.at[i] < kShownLeast) {
        // Somewhat beyond the outline, which would waver as the grid's points lie within it or not.
        // Hair stands before the ears, shoulders lie in their plane. Beside the cheek the sheet
        // stays near the cheek's depth, or its last pixels would be drawn long.
        const float far =
            glm::mix(look("hair_depth"), look("shoulder_depth"),
                     glm::smoothstep(chin.at().y, chin.at().y - kToShoulders, about.y));
        const float near = std::max(beside.at[i] / std::max(share.at[i], 1e-3F) - turns, far);
        depth.at[i] = glm::mix(far, near, Ramp(kFadeDepth, share.at[i]));
        fixed.at[i] = 1;
      }
    }
  }
  SolvePoisson(fixed, depth);
  // A steep fall, as from the jaw to the neck, would fold when the head turns.
  const FloatImage spanned = depth;
  depth = Blurred(Blurred(depth, 1), 1);
  for (std::size_t i = 0; i < depth.at.size(); ++i) {
    if (skin.inner.at[i] > 0) depth.at[i] = std::min(depth.at[i], spanned.at[i]);
  }
  return depth;
}

/// Corners of the cells of the sheet that are drawn, counter-clockwise.
using Quads = std::vector<std::array<std::uint32_t, 4>>;
Quads DrawnCells(const FittedHead& fitted, const SampleGrid& grid, const FloatImage& shown,
                 FloatImage covered, int rim, const FloatImage& depth) {
  FillHoles(covered);
  // Nothing behind the middle of the face: there are the mouth and the eyes.
  const FloatImage within = Blurred(covered, rim);
  const HeadOpenings openings(fitted);
  const auto about = [&](int x, int y) {
    return fitted.pose.PlaceAt(grid.Point(x, y), depth(x, y));
  };
  const auto hidden = [&](int x, int y) {
    return within.at[depth.Index(x, y)] > kWholeWithin || openings.Behind(about(x, y));
  };
  // In a photo of few pixels a cell may be wider than what is left between lips and cheek.
  const auto in_mouth = [&](int x, int y) {
    int corners = 0;
    for (int k = 0; k < 4; ++k) corners += openings.BehindMouth(about(x + k % 2, y + k / 2));
    return corners >= 2;
  };
  const auto opacity = [&](int x, int y) { return shown(std::max(x, 0), std::max(y, 0)); };
  Quads quads;
  for (int y = 0; y + 1 < grid.rows; ++y) {
    for (int x = 0; x + 1 < grid.columns; ++x) {
      if (std::max({opacity(x, y), opacity(x + 1, y), opacity(x, y + 1), opacity(x + 1, y + 1),
                    opacity(x - 1, y), opacity(x, y - 1)}) <= 0) {
        continue;
      }
      if (hidden(x, y) && hidden(x + 1, y) && hidden(x, y + 1) && hidden(x + 1, y + 1)) continue;
      if (in_mouth(x, y)) continue;
      const auto at = [&](int dx, int dy) {
        return static_cast<std::uint32_t>(depth.Index(x + dx, y + dy));
      };
      quads.push_back({at(0, 0), at(0, 1), at(1, 1), at(1, 0)});
    }
  }
  return quads;
}

/// A picture whose unknown pixels are filled from around, with grain.
fsm::Image FilledIn(fsm::Image image, const FloatImage& known, float pixels_per_mm) {
  PushPullInpaint(image, known);
  const int grain = std::max(static_cast<int>(PhotoLook()("hole_grain") * pixels_per_mm), 2);
  // In a small photo a pixel is as coarse as grain: none is added.
  const float amount = Ramp(PhotoLook().Pair("hole_grain_pixels"), pixels_per_mm);
  AddGrain(known, FloatImage(image.width, image.height, amount), grain, image);
  return image;
}

}  // namespace

fsm::Image BehindFace(const FittedHead& fitted, const Cutout& figure) {
  const int width = figure.colours.width, height = figure.colours.height;
  const Chin chin(fitted);
  FloatImage face =
      SeenSkin(fitted, fitted.pose, {glm::vec2(0.5F), 1, width, height}, chin.SkinBottom())
          .Covered();
  FillHoles(face);
  // Somewhat smaller than the skin, whose edge shows the same as the sheet's there. Forehead and
  // temples are mostly hair already, so the hole begins at the brows. Before the neck it is as
  // large as the skin, or the chin would be seen a second time.
  const float pixels_per_mm = fitted.pose.PixelsPerMm();
  const float face_hole = PhotoLook()("hole_face"), neck_hole = PhotoLook()("hole_neck");
  const glm::vec2 hole_edge = PhotoLook().Pair("hole_edge");
  const glm::vec2 neck_edge = PhotoLook().Pair("hole_neck_edge");
  const FloatImage soft =
      Blurred(face, std::max(static_cast<int>(PhotoLook()("hole_soft") * pixels_per_mm), 1));
  FloatImage keep(width, height, 1), beside(width, height, 1), below(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec2 pixel = glm::vec2(x, y) + 0.5F;
      const glm::vec3 about = fitted.pose.PlaceAt(pixel, kUsualDepth);
      const std::size_t i = keep.Index(x, y);
      const float most = glm::mix(face_hole, neck_hole, chin.BeforeNeck(about));
      keep.at[i] = Ramp(most + hole_edge, soft.at[i]);
      beside.at[i] = Ramp(neck_hole + neck_edge, soft.at[i]);
      below.at[i] = chin.Below(about);
    }
  }
  fsm::Image out = FilledIn(figure.colours, keep, pixels_per_mm);
  // Behind the jaw lies what is below it, not what is on it.
  const fsm::Image neck = FilledIn(figure.colours, beside, pixels_per_mm);
  for (std::size_t i = 0; i < keep.at.size(); ++i) {
    const float part = below.at[i] * (1 - keep.at[i]);
    if (part > 0) SetRgb(out, i, glm::mix(Rgb(out, i), Rgb(neck, i), part));
  }
  return out;
}

Sheet MakeSheet(const FittedHead& fitted, const Cutout& figure) {
  const float pixels_per_mm = fitted.pose.PixelsPerMm();
  const Chin chin(fitted);
  const SampleGrid grid = GridOver(figure, pixels_per_mm);
  const VisibleSurface surface = SeenSkin(fitted, fitted.pose, grid, chin.SkinBottom());
  const GridSkin skin(
      surface,
      std::max(static_cast<int>(std::lround(PhotoLook()("sheet_rim") * pixels_per_mm / grid.step)),
               1));
  // Hair and neck beside the skin go with it.
  const VectorImage motion =
      Spread(MotionOn(surface, MotionToRest(fitted)), skin.covered, skin.rim);
  const auto shown = FloatImage::From(grid.columns, grid.rows, [&](int x, int y) {
    const glm::vec2 pixel = grid.Point(x, y);
    return figure.opacity.Between(pixel.x, pixel.y);
  });
  const FloatImage depth = SheetDepth(fitted, grid, chin, skin, Blurred(shown, 2));
  const glm::vec2 size(figure.colours.width, figure.colours.height);
  Sheet out{.vertices = {}, .triangles = {}, .skin_bottom_y = chin.SkinBottom()};
  for (int y = 0; y < grid.rows; ++y) {
    for (int x = 0; x < grid.columns; ++x) {
      const glm::vec2 pixel = grid.Point(x, y);
      const std::size_t i = depth.Index(x, y);
      const glm::vec2 at = glm::clamp(pixel / size, 0.5F / kMapSize, 1 - 0.5F / kMapSize);
      const glm::vec3 place = fitted.pose.PlaceAt(pixel, std::min(depth.at[i], kMostDepth));
      out.vertices.push_back({place + motion.at[i], {0.5F + 0.5F * at.x, at.y}});
    }
  }
  Quads quads = DrawnCells(fitted, grid, shown, skin.covered, skin.rim, depth);
  // From back to front: soft edges show what lies behind them.
  std::ranges::sort(quads, {}, [&](const auto& quad) {
    return std::pair(out.vertices[quad[0]].position.z + out.vertices[quad[2]].position.z, quad);
  });
  for (const auto& quad : quads) {
    for (const std::size_t k : {0U, 1U, 2U, 0U, 2U, 3U}) out.triangles.push_back(quad[k]);
  }
  return out;
}

}  // namespace facefit
