#include "face_fit/bake/sheet_depth.h"

#include <algorithm>
#include <glm/common.hpp>

#include "face_fit/image/filters.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

// Numbers of the method; those tuned by eye are in tables/photo_look.txt.
constexpr int kPoissonSteps = 400;
constexpr float kInnerWithin = 0.62F;  // share of skin around a point above which it is inner skin
constexpr float kDeepWithin = 0.95F;   // share of skin from which the sheet keeps its full distance
// Share of inner skin nearby over which its depth begins to count.
constexpr fsm::Range kFadeDepth{0, 0.25F};

/// Fills points that are not fixed with the solution of Poisson's equation for a slight constant
/// curvature: a soap film, a little rounder. Runs kPoissonSteps steps of Gauss and Seidel, not to
/// convergence.
FloatImage FillBySoapFilm(const Mask& fixed, FloatImage depth) {
  const float round = PhotoLook().sheet.round_mm;
  for (int step = 0; step < kPoissonSteps; ++step) {
    ForEachPixel(depth.width, depth.height, [&](int x, int y, std::size_t i) {
      if (fixed[i] > 0) return;
      const auto next = [&](int dx, int dy) {
        return depth(std::clamp(x + dx, 0, depth.width - 1),
                     std::clamp(y + dy, 0, depth.height - 1));
      };
      depth[i] = 0.25F * (next(1, 0) + next(-1, 0) + next(0, 1) + next(0, -1)) + round;
    });
  }
  return depth;
}

/// Returns the depth below the inner skin. `position`: approximate, of the grid's point `i`, head's
/// frame.
float UnderSkinDepth(const Chin& chin, const SkinOnGrid& skin, std::size_t i, glm::vec3 position) {
  // The sheet continues the skin at its edge and keeps a distance farther in.
  const float inward = fsm::SmoothStep(kInnerWithin, kDeepWithin, skin.within[i]);
  const auto& look = PhotoLook().sheet;
  const float under = skin.depth[i] - glm::mix(look.under_skin_edge_mm, look.under_skin_mm, inward);
  // The neck lies behind the lower face, with room for the jaw to open.
  return glm::mix(under, std::min(under, look.before_neck_most_mm),
                  chin.BeforeNeckShare(position)) -
         look.below_chin_back_mm * chin.BelowShare(position);
}

/// Returns the depth at the outline and beyond it; on the outline alone it would depend on which
/// points of the grid lie inside. `beside`: depth of inner skin nearby; `i`, `position`: as for
/// UnderSkinDepth.
float OutlineDepth(const Chin& chin, const WeightedBlur<float>& beside, std::size_t i,
                   glm::vec3 position) {
  // Hair lies before the ears, shoulders in their plane. Beside the cheek the sheet stays near
  // its depth, or the sheet's last pixels would be stretched.
  const auto& look = PhotoLook().sheet;
  const float outline = glm::mix(
      look.hair_depth_mm, look.shoulder_depth_mm,
      fsm::SmoothStep(chin.height(), chin.height() - look.shoulders_below_chin_mm, position.y));
  const float cheek = beside.MeanAt(i) - look.most_step_back_mm;
  return glm::mix(outline, std::max(cheek, outline), kFadeDepth.Ramp(beside.weight[i]));
}

}  // namespace

SkinOnGrid::SkinOnGrid(const VisibleSurface& surface, int rim_cells)
    : rim(rim_cells),
      depth(surface.depth()),
      covered(surface.Covered()),
      within(Blurred(covered, rim)),
      inner(depth.width, depth.height) {
  for (std::size_t i = 0; i < depth.size(); ++i) {
    inner[i] = covered[i] > 0 && within[i] > kInnerWithin ? 1.0F : 0.0F;
  }
}

FloatImage SheetDepth(const CameraPose& pose, const SampleGrid& grid, const Chin& chin,
                      const SkinOnGrid& skin, const Mask& shown) {
  const WeightedBlur<float> beside(skin.depth, skin.inner, skin.rim);
  FloatImage depth(grid.columns, grid.rows);
  Mask fixed(grid.columns, grid.rows);
  ForEachPixel(grid.columns, grid.rows, [&](int x, int y, std::size_t i) {
    const glm::vec3 position = pose.PositionOf(grid.Point(x, y), kBesideFaceDepthMm);
    const bool inner = skin.inner[i] > 0;
    const bool outside = skin.covered[i] <= 0 && shown[i] < PhotoLook().sheet.shown_from_share;
    if (!inner && !outside) return;
    depth[i] =
        inner ? UnderSkinDepth(chin, skin, i, position) : OutlineDepth(chin, beside, i, position);
    fixed[i] = 1;
  });
  const FloatImage spanned = FillBySoapFilm(fixed, std::move(depth));
  // A steep step, as from jaw to neck, would fold when the head turns.
  FloatImage smooth = Blurred(Blurred(spanned, 1), 1);
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    if (skin.inner[i] > 0) smooth[i] = std::min(smooth[i], spanned[i]);
  }
  return smooth;
}

}  // namespace facefit
