#include "face_fit/bake/bake_head.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "face_fit/bake/behind_face.h"
#include "face_fit/bake/eye_textures.h"
#include "face_fit/bake/feature_colours.h"
#include "face_fit/bake/head_atlas.h"
#include "face_fit/bake/lips.h"
#include "face_fit/bake/mirroring.h"
#include "face_fit/bake/openings.h"
#include "face_fit/bake/sheet.h"
#include "face_fit/bake/side_photo_blend.h"
#include "face_fit/bake/skin_colours.h"
#include "face_fit/bake/skin_map.h"
#include "face_fit/bake/skin_texels.h"
#include "face_fit/bake/smile_folds.h"
#include "face_fit/bake/smile_shade.h"
#include "face_fit/fit/eye_fit.h"
#include "face_fit/fit/pixel_warp.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/grain.h"
#include "face_fit/image/pixels.h"
#include "face_fit/image/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

float SmileOf(const FittedHead& fitted) { return glm::clamp(fitted.expression.smile, 0.0F, 1.0F); }

/// Paints what the photo shows, except what lies between lids and between lips.
SkinMap PaintPhoto(const FoundFace& face, const FittedHead& fitted, const SkinTexels& texels,
                   const TexelProjections& projections, fsm::Image colours) {
  const PhotoLookNumbers& look = PhotoLook();
  const float pixels_per_mm = fitted.pose.PixelsPerMm();
  const Mask filled =
      FillSmileFolds(face, look.smile.folds.filled_share * SmileOf(fitted), pixels_per_mm, colours);
  const PhotoOpenings openings(face, pixels_per_mm);
  SkinMap map;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (!texels[i] || !projections[i]) continue;
    const auto& [p, z_mm, facing] = *projections[i];
    // Near the head's outline a texel shows more of what lies beside the head than of its skin.
    const float least =
        glm::mix(look.texel.face_from_cos, look.texel.side_from_cos, texels[i]->flank_weight);
    if (!IsInside(colours, p) || facing < least) continue;
    const float skin = openings.SkinShare(p);
    map.outside_openings[i] = skin;
    map.coverage[i] = skin * fsm::SmoothStep(least, least + look.texel.full_coverage_cos, facing);
    map.grain_lost[i] = filled.SampleAt(p.x, p.y);
    SetRgb(map.image, i, SharpColourAt(colours, p));
  }
  return map;
}

/// Returns whether a texel counts as face: skin in rows of the map from the hairline to the throat.
bool OnFace(const SkinTexels& texels, std::size_t i) {
  constexpr std::size_t kHairline = kMapSize / 5, kThroat = kMapSize * 3 / 4;  // rows
  const std::size_t row = i / kMapSize;
  return texels[i] && row > kHairline && row < kThroat;
}

/// Returns the coverage of the face, 0 on the sides and the back of the head.
Mask CoverageOfFace(const SkinTexels& texels, Mask coverage) {
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    if (!OnFace(texels, i)) coverage[i] = 0;
  }
  return coverage;
}

/// Returns the mean coverage of the face.
float MeanCoverage(const SkinTexels& texels, const Mask& coverage) {
  float count = 0, sum = 0;
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    if (!OnFace(texels, i)) continue;
    count += 1;
    sum += coverage[i];
  }
  return sum / std::max(count, 1.0F);
}

/// PhotoHead::saturation and PhotoHead::lined.
struct SkinTraits {
  float saturation, lined;
};

/// Completes the map where the photo does not show it, and sets its alpha to how much is skin. The
/// order of the passes matters:
/// - the other side is copied before anything is inpainted from around;
/// - a smile's shading is removed when no hole is left, because it is estimated from around;
/// - grain is added to what was filled in after its colours are final;
/// - lips and the lip seam, which are not skin, are painted over all of that;
/// - skin is detected in the finished colours.
SkinTraits FinishMap(const FittedHead& fitted, const SkinTexels& texels, bool lips_apart,
                     SkinMap& map) {
  const PhotoLookNumbers& look = PhotoLook();
  const float saturation = Saturation(map.image, map.coverage);
  CompleteByMirroring(map.outside_openings, map.image, map.coverage);
  PushPullInpaint(map.image, map.coverage);
  RemoveSmileShading(*fitted.base, texels, map.coverage,
                     look.smile.shade.evened_share * SmileOf(fitted), map.image);
  GrainFromCheeks(map.grain_lost, map.image);
  const auto on_sides = Mask::From(kMapSize, kMapSize, [&](int x, int y) {
    return texels(x, y) ? texels(x, y)->flank_weight : 0;
  });
  AddGrain(map.coverage, on_sides, MmToTexels(look.grain.coarsest_on_skin_mm, kMapSize), map.image);
  if (lips_apart) {
    RestoreLipColour(texels, map.image);
    DrawLipSeam(texels, saturation, map.image);
  }
  const Mask face_coverage = CoverageOfFace(texels, map.coverage);
  const fsm::Range range = look.creases.roughness;
  const float rough = (Roughness(map.image, face_coverage) - range.from) / (range.to - range.from);
  constexpr float kBrowsEndMm = 27;  // above the nasion
  const float brows_y_mm = fitted.base->head().Landmark("nasion").y + kBrowsEndMm;
  const Mask likeness = CutAtHairline(texels, brows_y_mm, SkinLikeness(map.image, face_coverage));
  for (std::size_t i = 0; i < likeness.size(); ++i) {
    map.image.rgba[4 * i + 3] = Byte(255 * likeness[i]);
  }
  return {.saturation = saturation,
          .lined = glm::mix(look.creases.smooth_skin_share, 1.0F, glm::clamp(rough, 0.0F, 1.0F))};
}

void SetColours(const FoundFace& face, const PhotoIrises& irises, const fsm::Image& photo,
                fsm::PhotoHead& head) {
  const EyeColours eyes = SampleEyes(face, irises, photo);
  head.iris_colour = eyes.iris;
  head.white_colour = eyes.white;
  head.iris_size = irises.size;
  const MouthColours mouth = SampleMouth(face, photo);
  head.teeth = mouth.teeth;
  head.lip_colour = mouth.lip;
}

void SetSheet(Sheet sheet, fsm::PhotoHead& head) {
  head.skin_bottom_y = sheet.skin_bottom_y;
  head.sheet = std::move(sheet.vertices);
  head.sheet_triangles = std::move(sheet.triangles);
}

}  // namespace

BakedHead BakeHead(const FoundFace& face, const FaceFit& fit, const fsm::Image& photo,
                   const FigureCutout& figure, const CompletedFigure& whole,
                   std::span<const PosedSidePhoto> side_photos, bool glasses) {
  const FittedHead& fitted = fit.head;
  fsm::PhotoHead head = PhotoHeadOf(fitted);
  head.glasses = glasses;
  head.seen_from = fitted.pose.TowardsCamera();
  const SkinTexels texels = FindSkinTexels(*fitted.base);
  TexelProjections front = ProjectTexels(fitted, texels, fitted.pose);
  HideSelfOccluded(fitted, fitted.pose, front);
  SkinMap map = PaintPhoto(face, fitted, texels, front, figure.colours);
  for (const PosedSidePhoto& view : side_photos) {
    BlendSidePhoto(fitted, view, texels, front, map);
    head.also_seen.push_back(view.pose.TowardsCamera());
  }
  const float coverage = MeanCoverage(texels, map.coverage);
  const SkinTraits traits = FinishMap(fitted, texels, LipsApart(face), map);
  head.saturation = traits.saturation;
  head.lined = traits.lined;
  head.skin_low = kSkinLow;
  head.skin_high = kSkinHigh;
  SetSheet(MakeSheet(fitted, whole.pose, whole.figure), head);
  fsm::Image atlas = PackAtlas(map.image, BehindFace(fitted, whole.pose, whole.figure),
                               whole.figure.opacity, fitted.pose.PixelsPerMm());
  // PhotoHeadOf has the eyes as in the photo's expression.
  const fsm::Sided<fsm::EyeTransform> eyes = EyesAtRest(fitted);
  head.eyes = eyes;
  head.eye_pictures = PaintEyes(face, fit, eyes, photo, atlas);
  SetColours(face, fit.irises, photo, head);
  head.atlas = std::make_shared<fsm::Image>(std::move(atlas));
  return {std::move(head), coverage};
}

}  // namespace facefit
