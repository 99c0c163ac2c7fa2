#include "face_fit/bake/side_blend.h"

#include <algorithm>
#include <glm/common.hpp>

#include "face_fit/bake/light_gain.h"
#include "face_fit/bake/openings.h"
#include "face_fit/find/face/mouth_line.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/picture/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

// Limits for skin that both photos show well, so that their light can be compared: coverage by the
// first photo, cosines of the angles to both cameras, distance from the middle of the face.
constexpr float kCoveredFront = 0.9F, kFacingFront = 0.4F, kFacingSide = 0.5F, kFromMiddleMm = 5;

/// Least combined coverage, divided by the first photo's alone.
constexpr float kHardly = 0.01F;

}  // namespace

void BlendSideView(const FittedHead& fitted, const SideView& view, const SkinTexels& front,
                   SkinMap& map) {
  // The view counts on its own side only. The far cheek, which the nose may hide, is left out by
  // across_mm of the table, so that occlusion need not be computed.
  const SkinTexels texels = ProjectSkin(fitted, view.pose, SelfHidden::kIgnored);
  const float towards = view.pose.TowardsCamera().x > 0 ? 1.0F : -1.0F;
  const fsm::Image& colours = view.figure.colours;
  const FoundFace& face = *view.side_photo->face;
  const PhotoOpenings openings(face, view.pose.PixelsPerMm(), LipsApart(face));
  // A gain for each channel matches the light of both photos.
  glm::vec3 front_sum(1), side_sum(1);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (map.coverage[i] < kCoveredFront || front[i].facing < kFacingFront ||
        texels[i].facing < kFacingSide || towards * front[i].x_mm < kFromMiddleMm ||
        !IsInside(colours, texels[i].pixel)) {
      continue;
    }
    front_sum += Rgb(map.image, i);
    side_sum += ColourAt(colours, texels[i].pixel);
  }
  const glm::vec3 gain = LightGain(front_sum, side_sum);
  const auto& look = PhotoLook().side_photo;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    // At a grazing angle a texel would be sampled from a line of pixels.
    const glm::vec2 pixel = texels[i].pixel;
    if (texels[i].facing < look.facing_cos.x || !IsInside(colours, pixel)) continue;
    if (map.outside_openings[i] < 1) continue;
    float& coverage = map.coverage[i];
    const float seen = fsm::SmoothStep(look.facing_cos, texels[i].facing) *
                       fsm::SmoothStep(look.across_mm, towards * front[i].x_mm) *
                       openings.SkinShare(pixel);
    const float own = coverage * fsm::SmoothStep(look.front_facing_cos, front[i].facing);
    const float sum = own + (1 - own) * seen;
    // Skin that the view hardly shows either stays as in the first photo.
    if (seen <= 0 || sum <= kHardly * coverage) continue;
    const float blend = (1 - own) * seen / std::max(sum, 1e-4F);
    const glm::vec3 colour = glm::min(gain * ColourAt(colours, pixel), 255.0F);
    SetRgb(map.image, i, glm::mix(Rgb(map.image, i), colour, blend));
    coverage = std::max(coverage, sum);
  }
}

}  // namespace facefit
