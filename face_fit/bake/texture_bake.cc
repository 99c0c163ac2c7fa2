#include "face_fit/bake/texture_bake.h"

#include <algorithm>
#include <glm/common.hpp>

#include "face_fit/bake/eye_pictures.h"
#include "face_fit/bake/feature_colours.h"
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

/// Strength of jaw and parting lips from which the photo shows an open mouth.
constexpr float kMouthOpen = 0.1F;

float Smile(const FittedHead& fitted) { return glm::clamp(fitted.expression.smile, 0.0F, 1.0F); }

bool InPhoto(const fsm::Image& photo, glm::vec2 p) {
  return p.x >= 0 && p.y >= 0 && p.x < static_cast<float>(photo.width) &&
         p.y < static_cast<float>(photo.height);
}

/// Lays a view from the side over what the first photo saw at a slant or not at all.
void BlendExtraView(const FittedHead& fitted, const ExtraView& extra, const SkinTexels& front,
                    fsm::Image& map, FloatImage& seen) {
  const CameraPose& pose = extra.fit.pose;
  const SkinTexels texels = ProjectSkin(fitted, pose, false);
  // What it shows is of the side towards it: the other cheek lies behind the nose.
  const float towards = pose.TowardsCamera().x > 0 ? 1.0F : -1.0F;
  const fsm::Image& colours = extra.figure.colours;
  // The same skin in another light: a gain for each channel makes it match. It is taken from what
  // both show well: cosines of the slant, millimetres from the middle.
  constexpr float kWellSeen = 0.9F, kFront = 0.4F, kAside = 0.5F, kFromMiddle = 5;
  glm::vec3 here(1), there(1);
  for (std::size_t i = 0; i < seen.at.size(); ++i) {
    if (seen.at[i] < kWellSeen || front.at[i].facing < kFront || texels.at[i].facing < kAside ||
        towards * front.at[i].x_mm < kFromMiddle || !InPhoto(colours, texels.at[i].pixel)) {
      continue;
    }
    here += Rgb(map, i);
    there += ColourAt(colours, texels.at[i].pixel);
  }
  const fsm::NumberTable& look = PhotoLook();
  const glm::vec2 limit = look.Pair("light_gain");
  const glm::vec2 facing = look.Pair("extra_facing"), across = look.Pair("extra_across");
  const glm::vec2 facing_front = look.Pair("extra_facing_front");
  const glm::vec3 gain = glm::clamp(here / there, limit.x, limit.y);
  for (std::size_t i = 0; i < seen.at.size(); ++i) {
    // Too slanted a texel is drawn from a line of pixels.
    if (texels.at[i].facing < facing.x || !InPhoto(colours, texels.at[i].pixel)) continue;
    const float can = Ramp(facing, texels.at[i].facing) * Ramp(across, towards * front.at[i].x_mm);
    const float known = seen.at[i] * Ramp(facing_front, front.at[i].facing);
    const float sum = known + (1 - known) * can;
    if (sum <= seen.at[i] * 0.01F || can <= 0) continue;
    const float part = (1 - known) * can / std::max(sum, 1e-4F);
    const glm::vec3 colour = glm::min(gain * ColourAt(colours, texels.at[i].pixel), 255.0F);
    SetRgb(map, i, glm::mix(Rgb(map, i), colour, part));
    seen.at[i] = std::max(seen.at[i], sum);
  }
}

/// The skin's map while it is painted.
struct PaintedMap {
  fsm::Image image = fsm::FilledImage(kMapSize, kMapSize);
  FloatImage seen{kMapSize, kMapSize};    ///< how well each texel was seen, 0..1
  FloatImage smooth{kMapSize, kMapSize};  ///< how much of its grain it lost, 0..1
  std::vector<bool> skin = std::vector<bool>(seen.at.size(), true);  ///< not within eyes or mouth
};

/// What the photo shows, but not what is between lids and lips.
PaintedMap PaintPhoto(const FoundFace& face, const FittedHead& fitted, const SkinTexels& texels,
                      bool open, fsm::Image colours) {
  const fsm::NumberTable& look = PhotoLook();
  const float least_on_face = look("facing_least"), least_aside = look("facing_least_aside");
  const float soft = look("facing_soft");
  const float pixels_per_mm = fitted.pose.PixelsPerMm();
  const FloatImage filled =
      FillSmileFolds(face, look("smile_folds_filled") * Smile(fitted), pixels_per_mm, colours);
  const Openings openings(face, pixels_per_mm, open);
  PaintedMap map;
  for (std::size_t i = 0; i < texels.at.size(); ++i) {
    const glm::vec2 p = texels.at[i].pixel;
    // Near the head's outline the photo shows more of what lies beside it than of its skin.
    const float least = glm::mix(least_on_face, least_aside, texels.at[i].aside);
    if (!InPhoto(colours, p) || texels.at[i].facing < least) continue;
    const float part = openings.SkinWeight(p);
    map.skin[i] = part >= 1;
    map.seen.at[i] = part * glm::smoothstep(least, least + soft, texels.at[i].facing);
    map.smooth.at[i] = filled.Between(p.x, p.y);
    SetRgb(map.image, i, SharpColourAt(colours, p));
  }
  return map;
}

/// Where lips that were apart now meet there is a dark line, reddish where the photo has colour.
void DrawMouthLine(const SkinTexels& texels, float saturation, fsm::Image& map) {
  const fsm::NumberTable& look = PhotoLook();
  const glm::vec3 dark =
      glm::mix(look.Vector("mouth_line_grey"), look.Vector("mouth_line_colour"), saturation);
  const glm::vec2 width = look.Pair("mouth_line_width");
  for (std::size_t i = 0; i < texels.at.size(); ++i) {
    const float line = Ramp(width, texels.at[i].off_seam_mm);
    if (line > 0) SetRgb(map, i, Rgb(map, i) * (1.0F - dark * line));
  }
}

/// Whether a texel belongs to what is counted as face.
bool OnFront(const SkinTexels& texels, std::size_t i) {
  return texels.at[i].outward > 0 && i / kMapSize > kMapSize / 5 && i / kMapSize < kMapSize * 3 / 4;
}

/// `seen`, but 0 where no face is but the sides and the back of the head.
FloatImage OnFace(const SkinTexels& texels, FloatImage seen) {
  for (std::size_t i = 0; i < seen.at.size(); ++i) {
    if (!OnFront(texels, i)) seen.at[i] = 0;
  }
  return seen;
}

/// How much of the face's part of the map was seen, 0..1.
float Coverage(const SkinTexels& texels, const FloatImage& seen) {
  float count = 0, sum = 0;
  for (std::size_t i = 0; i < seen.at.size(); ++i) {
    if (!OnFront(texels, i)) continue;
    count += 1;
    sum += seen.at[i];
  }
  return sum / std::max(count, 1.0F);
}

/// PhotoHead::saturation and PhotoHead::lined.
struct SkinLook {
  float saturation, lined;
};

/// Completes the map where the photo does not show it, and says in its alpha what is skin.
SkinLook FinishMap(const FittedHead& fitted, const SkinTexels& texels, bool open, PaintedMap& map) {
  const fsm::NumberTable& look = PhotoLook();
  const float saturation = Saturation(map.image, map.seen);
  CompleteByMirroring(map.skin, map.image, map.seen);
  PushPullInpaint(map.image, map.seen);
  RemoveSmileShading(*fitted.base, texels, map.seen, look("smile_shade_evened") * Smile(fitted),
                     map.image);
  GrainFromCheeks(map.smooth, map.image);
  const auto aside =
      FloatImage::From(kMapSize, kMapSize, [&](int x, int y) { return texels(x, y).aside; });
  AddGrain(map.seen, aside, kMapSize / 170, map.image);
  if (open) {
    RestoreLipColour(texels, map.image);
    DrawMouthLine(texels, saturation, map.image);
  }
  const FloatImage face_seen = OnFace(texels, map.seen);
  const glm::vec2 range = look.Pair("roughness");
  const float rough = (Roughness(map.image, face_seen) - range.x) / (range.y - range.x);
  FloatImage likeness = SkinLikeness(map.image, face_seen);
  CutAtHairline(texels, likeness);
  for (std::size_t i = 0; i < likeness.at.size(); ++i) {
    map.image.rgba[4 * i + 3] = Byte(255 * likeness.at[i]);
  }
  return {.saturation = saturation,
          .lined = glm::mix(look("crease_smooth"), 1.0F, glm::clamp(rough, 0.0F, 1.0F))};
}

/// The map on the left, the figure on the right.
fsm::Image SideBySide(const fsm::Image& map, const fsm::Image& back, const FloatImage& opacity,
                      float pixels_per_mm) {
  // An edge as wide as a pixel of a small photo would look blurred: screens show two and more
  // pixels to a millimetre.
  constexpr float kShown = 2;
  const float steep = glm::clamp(kShown / pixels_per_mm, 1.0F, 3.0F);
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
                        const Cutout& figure, std::span<const ExtraView> extras) {
  const FittedHead& fitted = fit.head;
  TextureBake bake;
  const SkinTexels texels = ProjectSkin(fitted, fitted.pose, true);
  const bool open = fitted.expression.jaw + fitted.expression.parted > kMouthOpen;
  PaintedMap map = PaintPhoto(face, fitted, texels, open, figure.colours);
  std::vector<glm::vec3> also_seen;
  for (const ExtraView& extra : extras) {
    if (extra.outline_only) continue;
    BlendExtraView(fitted, extra, texels, map.image, map.seen);
    also_seen.push_back(extra.fit.pose.TowardsCamera());
  }
  bake.coverage = Coverage(texels, map.seen);
  const SkinLook skin = FinishMap(fitted, texels, open, map);
  const CompletedFigure whole = CompleteFigure(fitted, figure);
  bake.completed = whole.completed;
  fsm::Image picture = SideBySide(map.image, BehindFace(whole.head, whole.figure),
                                  whole.figure.opacity, fitted.pose.PixelsPerMm());
  const auto eyes = EyesAtRest(fitted);
  const EyeColours eye_colours = SampleEyes(face, fit.irises, photo);
  const MouthColours mouth = SampleMouth(face, photo);
  Sheet sheet = MakeSheet(whole.head, whole.figure);
  // Half a texel within, so that the halves do not run into each other.
  constexpr float kHalf = 0.25F / kMapSize;
  bake.head = {.base = fitted.base->name,
               .points = fitted.points,
               .smooth = fitted.smooth,
               .eyes = eyes,
               .iris_colour = eye_colours.iris,
               .white_colour = eye_colours.white,
               .iris_size = fit.irises.size,
               .teeth = mouth.teeth,
               .glasses = BridgeContrast(face, photo) > kGlassesContrast,
               .lip_colour = mouth.lip,
               .eye_pictures = PaintEyes(face, fit, eyes, photo, picture),
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
  return bake;
}

}  // namespace facefit
