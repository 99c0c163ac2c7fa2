#include "face_fit/bake/side_photo_blend.h"

#include <algorithm>
#include <glm/common.hpp>

#include "face_fit/bake/openings.h"
#include "face_fit/bake/skin_colours.h"
#include "face_fit/image/pixels.h"
#include "face_fit/image/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

// Limits for skin that both photos show well, so that their light can be compared: coverage by the
// front photo, cosines of the angles to both cameras, distance from the middle of the face.
constexpr float kCoveredFront = 0.9F, kFacingFront = 0.4F, kFacingSide = 0.5F, kFromMiddleMm = 5;

/// Least combined coverage, divided by the front photo's alone.
constexpr float kMinCoverageRatio = 0.01F;

/// Returns the gain of each channel that brings the colours of a view into the front photo's light.
/// `towards`: 1 if the view shows the person's left side, else -1.
glm::vec3 GainToFront(const SkinTexels& texels, const TexelProjections& front,
                      const TexelProjections& side, float towards, const fsm::Image& colours,
                      const SkinMap& map) {
  glm::vec3 front_sum(1), side_sum(1);
  for (std::size_t i = 0; i < side.size(); ++i) {
    if (!texels[i] || !front[i] || !side[i]) continue;
    if (map.coverage[i] < kCoveredFront || front[i]->facing < kFacingFront ||
        side[i]->facing < kFacingSide || towards * texels[i]->x_mm < kFromMiddleMm ||
        !IsInside(colours, side[i]->pixel)) {
      continue;
    }
    front_sum += Rgb(map.image, i);
    side_sum += ColourAt(colours, side[i]->pixel);
  }
  return LightGain(front_sum, side_sum);
}

}  // namespace

void BlendSidePhoto(const FittedHead& fitted, const PosedSidePhoto& view, const SkinTexels& texels,
                    const TexelProjections& front, SkinMap& map) {
  // The view counts on its own side only. The far cheek, which the nose may hide, is left out by
  // across_mm of the table, so that occlusion need not be computed.
  const TexelProjections side = ProjectTexels(fitted, texels, view.pose);
  const float towards = view.pose.TowardsCamera().x > 0 ? 1.0F : -1.0F;
  const fsm::Image& colours = view.figure.colours;
  const PhotoOpenings openings(view.face, view.pose.PixelsPerMm());
  const glm::vec3 gain = GainToFront(texels, front, side, towards, colours, map);
  const auto& look = PhotoLook().side_photo;
  for (std::size_t i = 0; i < side.size(); ++i) {
    if (!texels[i] || !side[i] || map.outside_openings[i] < 1) continue;
    // At a grazing angle a texel would be sampled from a line of pixels.
    const auto& [pixel, z_mm, facing] = *side[i];
    if (facing < look.facing_cos.from || !IsInside(colours, pixel)) continue;
    float& coverage = map.coverage[i];
    const float seen = look.facing_cos.Ramp(facing) *
                       look.across_mm.Ramp(towards * texels[i]->x_mm) * openings.SkinShare(pixel);
    const float own = front[i] ? coverage * look.front_facing_cos.Ramp(front[i]->facing) : 0;
    const float sum = own + (1 - own) * seen;
    // Skin that the view hardly shows either stays as in the front photo.
    if (seen <= 0 || sum <= kMinCoverageRatio * coverage) continue;
    const float blend = (1 - own) * seen / std::max(sum, 1e-4F);
    const glm::vec3 colour = glm::min(gain * ColourAt(colours, pixel), 255.0F);
    SetRgb(map.image, i, glm::mix(Rgb(map.image, i), colour, blend));
    coverage = std::max(coverage, sum);
  }
}

}  // namespace facefit
