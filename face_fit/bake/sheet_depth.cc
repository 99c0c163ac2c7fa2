#include "face_fit/bake/sheet_depth.h"

#include <algorithm>
#include <glm/common.hpp>

#include "face_fit/picture/filters.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

// Numbers that are not to be tuned by eye; the others are in tables/photo_look.txt.
constexpr int kPoissonSteps = 400;
constexpr float kInnerWithin = 0.62F;  // of what is around is skin: from here on skin is inner
constexpr float kDeepWithin = 0.95F;   // of what is around: the skin there keeps its whole distance
constexpr float kShownLeast = 0.12F;   // opacity below which a point lies outside the figure
constexpr float kToShouldersMm = 70;   // below the chin
constexpr glm::vec2 kFadeDepth{0, 0.25F};  // over how much of what is around the skin's depth fades

/// Fills what is not fixed with the solution of Poisson's equation for an even, slight curvature:
/// as a skin of soap would span it, but a little rounder. By Gauss and Seidel, not to the end.
FloatImage Spanned(const FloatImage& fixed, FloatImage depth) {
  const float round = PhotoLook().sheet.round_mm;
  for (int step = 0; step < kPoissonSteps; ++step) {
    for (int y = 0; y < depth.height; ++y) {
      for (int x = 0; x < depth.width; ++x) {
        const std::size_t i = depth.Index(x, y);
        if (fixed.values[i] > 0) continue;
        const auto next = [&](int dx, int dy) {
          return depth(std::clamp(x + dx, 0, depth.width - 1),
                       std::clamp(y + dy, 0, depth.height - 1));
        };
        depth.values[i] = 0.25F * (next(1, 0) + next(-1, 0) + next(0, 1) + next(0, -1)) + round;
      }
    }
  }
  return depth;
}

/// Under the inner skin.
class UnderSkinDepth {
 public:
  UnderSkinDepth(const Chin& chin, const GridSkin& skin) : chin_(chin), skin_(skin) {}
  /// `place`: about where the point of the grid lies, head's frame.
  float DepthAt(std::size_t i, glm::vec3 place) const {
    // At the skin's edge the sheet goes on from it, further in it keeps out of its way.
    const float inward = glm::smoothstep(kInnerWithin, kDeepWithin, skin_.within.values[i]);
    const auto& look = PhotoLook().sheet;
    const float under =
        skin_.depth.values[i] - glm::mix(look.under_skin_edge_mm, look.under_skin_mm, inward);
    // Behind the lower face lies the neck; the jaw has room to open.
    return glm::mix(under, std::min(under, look.before_neck_most_mm), chin_.BeforeNeck(place)) -
           look.below_chin_back_mm * chin_.Below(place);
  }

 private:
  const Chin& chin_;
  const GridSkin& skin_;
};

/// At the outline and somewhat beyond it; the outline itself would waver as the grid's points lie
/// within it or not.
class OutlineDepth {
 public:
  OutlineDepth(const Chin& chin, const GridSkin& skin)
      : chin_(chin), beside_(skin.depth), share_(Blurred(skin.inner, skin.rim)) {
    for (std::size_t i = 0; i < beside_.values.size(); ++i) {
      beside_.values[i] *= skin.inner.values[i];
    }
    beside_ = Blurred(beside_, skin.rim);
  }
  /// `place`: as of UnderSkinDepth.
  float DepthAt(std::size_t i, glm::vec3 place) const {
    // Hair stands before the ears, shoulders lie in their plane. Beside the cheek the sheet stays
    // near the cheek's depth, or its last pixels would be drawn long.
    const auto& look = PhotoLook().sheet;
    const float outline =
        glm::mix(look.hair_depth_mm, look.shoulder_depth_mm,
                 glm::smoothstep(chin_.height(), chin_.height() - kToShouldersMm, place.y));
    const float cheek = beside_.values[i] / std::max(share_.values[i], 1e-3F) - look.falls_back_mm;
    return glm::mix(outline, std::max(cheek, outline),
                    fsm::SmoothStep(kFadeDepth, share_.values[i]));
  }

 private:
  const Chin& chin_;
  FloatImage beside_, share_;  // the depth of inner skin nearby, and how much there is of it, 0..1
};

}  // namespace

GridSkin::GridSkin(const VisibleSurface& surface, int rim_cells)
    : rim(rim_cells),
      depth(surface.depth()),
      covered(surface.Covered()),
      within(Blurred(covered, rim)),
      inner(depth.width, depth.height) {
  for (std::size_t i = 0; i < depth.values.size(); ++i) {
    inner.values[i] = covered.values[i] > 0 && within.values[i] > kInnerWithin ? 1.0F : 0.0F;
  }
}

FloatImage SheetDepth(const FittedHead& fitted, const SampleGrid& grid, const Chin& chin,
                      const GridSkin& skin, const FloatImage& shown) {
  const UnderSkinDepth under_skin(chin, skin);
  const OutlineDepth at_outline(chin, skin);
  FloatImage depth(grid.columns, grid.rows), fixed(depth);
  for (int y = 0; y < grid.rows; ++y) {
    for (int x = 0; x < grid.columns; ++x) {
      const std::size_t i = depth.Index(x, y);
      const glm::vec3 place = fitted.pose.PlaceAt(grid.Point(x, y), kBesideFaceDepth);
      const bool inner = skin.inner.values[i] > 0;
      const bool outside = skin.covered.values[i] <= 0 && shown.values[i] < kShownLeast;
      if (!inner && !outside) continue;
      depth.values[i] = inner ? under_skin.DepthAt(i, place) : at_outline.DepthAt(i, place);
      fixed.values[i] = 1;
    }
  }
  const FloatImage spanned = Spanned(fixed, std::move(depth));
  // A steep fall, as from the jaw to the neck, would fold when the head turns.
  FloatImage smooth = Blurred(Blurred(spanned, 1), 1);
  for (std::size_t i = 0; i < smooth.values.size(); ++i) {
    if (skin.inner.values[i] > 0) smooth.values[i] = std::min(smooth.values[i], spanned.values[i]);
  }
  return smooth;
}

}  // namespace facefit
