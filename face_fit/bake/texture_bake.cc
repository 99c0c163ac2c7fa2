#include "face_fit/bake/texture_bake.h"

#include <algorithm>
#include <glm/common.hpp>
#include <utility>

#include "face_fit/bake/behind_face.h"
#include "face_fit/bake/eye_pictures.h"
#include "face_fit/bake/feature_colours.h"
#include "face_fit/bake/light_gain.h"
#include "face_fit/bake/lips.h"
#include "face_fit/bake/openings.h"
#include "face_fit/bake/other_side.h"
#include "face_fit/bake/sheet.h"
#include "face_fit/bake/skin_colours.h"
#include "face_fit/bake/skin_texels.h"
#include "face_fit/bake/smile_folds.h"
#include "face_fit/bake/smile_shade.h"
#include "face_fit/find/face/glasses.h"
#include "face_fit/find/figure/matte.h"
#include "face_fit/fit/eye_fit.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/grain.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/picture/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Widest variation of brightness that counts as grain.
constexpr float kGrainMm = 1.5F;

float SmileOf(const FittedHead& fitted) { return glm::clamp(fitted.expression.smile, 0.0F, 1.0F); }

// Limits for skin that both photos show well, so that their light can be compared: coverage by the
// first photo, cosines of the angles to both cameras, distance from the middle of the face.
constexpr float kCoveredFront = 0.9F, kFacingFront = 0.4F, kFacingSide = 0.5F, kFromMiddleMm = 5;

/// Least combined coverage, divided by the first photo's alone.
constexpr float kHardly = 0.01F;

/// Blends a view from the side over skin that the first photo saw at a grazing angle or not at all.
void BlendSideView(const FittedHead& fitted, const SideView& view, const SkinTexels& front,
                   fsm::Image& map, FloatImage& coverage) {
  // The view counts on its own side only. The far cheek, which the nose may hide, is left out by
  // across_mm of the table, so that occlusion need not be computed.
  const SkinTexels texels = ProjectSkin(fitted, view.pose, SelfHidden::kIgnored);
  const float towards = view.pose.TowardsCamera().x > 0 ? 1.0F : -1.0F;
  const fsm::Image& colours = view.figure.colours;
  // A gain for each channel matches the light of both photos.
  glm::vec3 front_sum(1), side_sum(1);
  for (std::size_t i = 0; i < coverage.values.size(); ++i) {
    if (coverage.values[i] < kCoveredFront || front.values[i].facing < kFacingFront ||
        texels.values[i].facing < kFacingSide || towards * front.values[i].x_mm < kFromMiddleMm ||
        !IsInside(colours, texels.values[i].pixel)) {
      continue;
    }
    front_sum += Rgb(map, i);
    side_sum += ColourAt(colours, texels.values[i].pixel);
  }
  const glm::vec3 gain = LightGain(front_sum, side_sum);
  const auto& look = PhotoLook().side_photo;
  for (std::size_t i = 0; i < coverage.values.size(); ++i) {
    // At a grazing angle a texel would be sampled from a line of pixels.
    if (texels.values[i].facing < look.facing_cos.x || !IsInside(colours, texels.values[i].pixel))
      continue;
    const float seen = fsm::SmoothStep(look.facing_cos, texels.values[i].facing) *
                       fsm::SmoothStep(look.across_mm, towards * front.values[i].x_mm);
    const float own =
        coverage.values[i] * fsm::SmoothStep(look.front_facing_cos, front.values[i].facing);
    const float sum = own + (1 - own) * seen;
    // Skin that the view hardly shows either stays as in the first photo.
    if (seen <= 0 || sum <= kHardly * coverage.values[i]) continue;
    const float blend = (1 - own) * seen / std::max(sum, 1e-4F);
    const glm::vec3 colour = glm::min(gain * ColourAt(colours, texels.values[i].pixel), 255.0F);
    SetRgb(map, i, glm::mix(Rgb(map, i), colour, blend));
    coverage.values[i] = std::max(coverage.values[i], sum);
  }
}

/// The skin's map while it is painted.
struct PaintedMap {
  fsm::Image image = fsm::FilledImage(kMapSize, kMapSize);
  FloatImage coverage{kMapSize, kMapSize};  ///< how well the photo shows each texel, 0..1
  FloatImage smooth{kMapSize, kMapSize};    ///< part of its grain that each texel lost, 0..1
  std::vector<bool> skin =
      /// Whether a texel is outside eyes and mouth.
      std::vector<bool>(coverage.values.size(), true);
};

/// Paints what the photo shows, except what lies between lids and between lips.
PaintedMap PaintPhoto(const FoundFace& face, const FittedHead& fitted, const SkinTexels& texels,
                      bool open, fsm::Image colours) {
  const PhotoLookNumbers& look = PhotoLook();
  const float pixels_per_mm = fitted.pose.PixelsPerMm();
  const FloatImage filled =
      FillSmileFolds(face, look.smile.folds.filled_part * SmileOf(fitted), pixels_per_mm, colours);
  const PhotoOpenings openings(face, pixels_per_mm, open);
  PaintedMap map;
  for (std::size_t i = 0; i < texels.values.size(); ++i) {
    const glm::vec2 p = texels.values[i].pixel;
    // Near the head's outline a texel shows more of what lies beside the head than of its skin.
    const float least =
        glm::mix(look.seen.face_from_cos, look.seen.aside_from_cos, texels.values[i].aside);
    if (!IsInside(colours, p) || texels.values[i].facing < least) continue;
    const float skin = openings.SkinWeight(p);
    map.skin[i] = skin >= 1;
    map.coverage.values[i] =
        skin * glm::smoothstep(least, least + look.seen.wholly_after_cos, texels.values[i].facing);
    map.smooth.values[i] = filled.SampleAt(p.x, p.y);
    SetRgb(map.image, i, SharpColourAt(colours, p));
  }
  return map;
}

/// Draws the dark line where lips that were apart now meet, reddish if the photo has colour.
void DrawMouthLine(const SkinTexels& texels, float saturation, fsm::Image& map) {
  const auto& look = PhotoLook().mouth_line;
  const glm::vec3 dark = glm::mix(look.takes_from_grey, look.takes_from_colour, saturation);
  for (std::size_t i = 0; i < texels.values.size(); ++i) {
    const float line = fsm::SmoothStep(look.off_seam_mm, texels.values[i].off_seam_mm);
    if (line > 0) SetRgb(map, i, Rgb(map, i) * (1.0F - dark * line));
  }
}

/// Returns whether a texel counts as face: skin in rows of the map from the hairline to the throat.
bool OnFace(const SkinTexels& texels, std::size_t i) {
  constexpr std::size_t kHairline = kMapSize / 5, kThroat = kMapSize * 3 / 4;
  const std::size_t row = i / kMapSize;
  return texels.values[i].outward_mm2 > 0 && row > kHairline && row < kThroat;
}

/// Returns the coverage of the face, 0 on the sides and the back of the head.
FloatImage CoverageOfFace(const SkinTexels& texels, FloatImage coverage) {
  for (std::size_t i = 0; i < coverage.values.size(); ++i) {
    if (!OnFace(texels, i)) coverage.values[i] = 0;
  }
  return coverage;
}

/// Returns the mean coverage of the face.
float MeanCoverage(const SkinTexels& texels, const FloatImage& coverage) {
  float count = 0, sum = 0;
  for (std::size_t i = 0; i < coverage.values.size(); ++i) {
    if (!OnFace(texels, i)) continue;
    count += 1;
    sum += coverage.values[i];
  }
  return sum / std::max(count, 1.0F);
}

/// PhotoHead::saturation and PhotoHead::lined.
struct SkinLook {
  float saturation, lined;
};

/// Completes the map where the photo does not show it, and sets its alpha to how much is skin. The
/// order of the passes matters:
/// - the other side is copied before anything is inpainted from around;
/// - a smile's shading is removed when no hole is left, because it is estimated from around;
/// - grain is added to what was filled in after its colours are final;
/// - lips and the line between them, which are not skin, are painted over all of that;
/// - skin is detected in the finished colours.
SkinLook FinishMap(const FittedHead& fitted, const SkinTexels& texels, bool open, PaintedMap& map) {
  const PhotoLookNumbers& look = PhotoLook();
  const float saturation = Saturation(map.image, map.coverage);
  CompleteByMirroring(map.skin, map.image, map.coverage);
  PushPullInpaint(map.image, map.coverage);
  RemoveSmileShading(*fitted.base, texels, map.coverage,
                     look.smile.shade.evened_part * SmileOf(fitted), map.image);
  GrainFromCheeks(map.smooth, map.image);
  const auto aside =
      FloatImage::From(kMapSize, kMapSize, [&](int x, int y) { return texels(x, y).aside; });
  AddGrain(map.coverage, aside, TexelsOf(kGrainMm, kMapSize), map.image);
  if (open) {
    RestoreLipColour(texels, map.image);
    DrawMouthLine(texels, saturation, map.image);
  }
  const FloatImage face_coverage = CoverageOfFace(texels, map.coverage);
  const glm::vec2 range = look.lined.roughness;
  const float rough = (Roughness(map.image, face_coverage) - range.x) / (range.y - range.x);
  const FloatImage likeness = CutAtHairline(texels, SkinLikeness(map.image, face_coverage));
  for (std::size_t i = 0; i < likeness.values.size(); ++i) {
    map.image.rgba[4 * i + 3] = Byte(255 * likeness.values[i]);
  }
  return {.saturation = saturation,
          .lined = glm::mix(look.lined.smooth_creases_part, 1.0F, glm::clamp(rough, 0.0F, 1.0F))};
}

/// Returns the map on the left and the figure on the right in one picture.
fsm::Image SideBySide(const fsm::Image& map, const fsm::Image& back, const FloatImage& opacity,
                      float pixels_per_mm) {
  // Steepens the opacity of small photos, whose edges, a pixel wide, would look blurred on screens
  // with two or more pixels to a millimetre.
  constexpr float kScreenPixelsPerMm = 2, kSteepest = 3;
  const float steep = glm::clamp(kScreenPixelsPerMm / pixels_per_mm, 1.0F, kSteepest);
  const glm::vec2 scale = glm::vec2(back.width, back.height) / static_cast<float>(kMapSize);
  fsm::Image out = fsm::FilledImage(2 * kMapSize, kMapSize);
  for (int y = 0; y < kMapSize; ++y) {
    for (int x = 0; x < kMapSize; ++x) {
      const glm::vec2 p = (glm::vec2(x, y) + 0.5F) * scale;
      const std::size_t left = out.Index(x, y);
      std::copy_n(&map.rgba[4 * map.Index(x, y)], 4, &out.rgba[4 * left]);
      SetRgb(out, left + kMapSize, SharpColourAt(back, p));
      out.rgba[4 * (left + kMapSize) + 3] =
          Byte(255 * (0.5F + steep * (SmoothAt(opacity, p) - 0.5F)));
    }
  }
  return out;
}

}  // namespace

TextureBake BakeTexture(const FoundFace& face, const Fit& fit, const fsm::Image& photo,
                        const FigureCutout& figure, std::span<const SideView> side_views) {
  const FittedHead& fitted = fit.head;
  const SkinTexels texels = ProjectSkin(fitted, fitted.pose, SelfHidden::kNotSeen);
  // The same flag decided whether the lips were fitted apart or to the line where they meet.
  const bool open = fit.targets.lips_apart;
  PaintedMap map = PaintPhoto(face, fitted, texels, open, figure.colours);
  std::vector<glm::vec3> also_seen;
  for (const SideView& view : side_views) {
    if (view.outline_only) continue;
    BlendSideView(fitted, view, texels, map.image, map.coverage);
    also_seen.push_back(view.pose.TowardsCamera());
  }
  const float coverage = MeanCoverage(texels, map.coverage);
  const SkinLook skin = FinishMap(fitted, texels, open, map);
  const CompletedFigure whole = CompleteFigure(fitted, figure);
  fsm::Image picture = SideBySide(map.image, BehindFace(whole.head, whole.figure),
                                  whole.figure.opacity, fitted.pose.PixelsPerMm());
  const auto eyes = EyesAtRest(fitted);
  auto eye_pictures = PaintEyes(face, fit, eyes, photo, picture);
  const EyeColours eye_colours = SampleEyes(face, fit.irises, photo);
  const MouthColours mouth = SampleMouth(face, photo);
  Sheet sheet = MakeSheet(whole.head, whole.figure);
  // Half a texel inward, so that the halves do not bleed into each other.
  constexpr float kHalf = 0.25F / kMapSize;
  fsm::PhotoHead head{.base = fitted.base->name(),
                      .points = fitted.warp_points,
                      .smooth = fitted.smooth_mm,
                      .eyes = eyes,
                      .iris_colour = eye_colours.iris,
                      .white_colour = eye_colours.white,
                      .iris_size = fit.irises.size,
                      .teeth = mouth.teeth,
                      .glasses = BridgeContrast(face, photo) > kGlassesContrast,
                      .lip_colour = mouth.lip,
                      .eye_pictures = std::move(eye_pictures),
                      .saturation = skin.saturation,
                      .lined = skin.lined,
                      .skin_low = {kHalf, 1},
                      .skin_high = {0.5F - kHalf, 0},
                      .seen_from = fitted.pose.TowardsCamera(),
                      .also_seen = std::move(also_seen),
                      .skin_bottom_y = sheet.skin_bottom_y,
                      .sheet = std::move(sheet.vertices),
                      .sheet_triangles = std::move(sheet.triangles),
                      .photo = std::make_shared<fsm::Image>(std::move(picture))};
  return {std::move(head), coverage, whole.completed};
}

}  // namespace facefit
