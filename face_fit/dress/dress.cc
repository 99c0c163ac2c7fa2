#include "face_fit/dress/dress.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "face_fit/dress/cover.h"
#include "face_fit/dress/enlarge.h"
#include "face_fit/dress/folds.h"
#include "face_fit/dress/grain.h"
#include "face_fit/dress/lips.h"
#include "face_fit/dress/matte.h"
#include "face_fit/dress/openings.h"
#include "face_fit/dress/other_side.h"
#include "face_fit/dress/sheet.h"
#include "face_fit/dress/skin_colours.h"
#include "face_fit/dress/skin_places.h"
#include "face_fit/dress/smile_shade.h"
#include "face_fit/find/glasses.h"

namespace facefit {
namespace {

bool InPhoto(const fsm::Image& photo, glm::vec2 p) {
  return p.x >= 0 && p.y >= 0 && p.x < static_cast<float>(photo.width) &&
         p.y < static_cast<float>(photo.height);
}

/// Lays a view from the side over what the first photo saw at a slant or not at all.
void LayOver(const BaseHead& base, const Fit& fit, const SideView& side, const SkinPlaces& front,
             fsm::Image& map, FloatImage& seen) {
  const Pose& pose = side.view.pose;
  const SkinPlaces places = PlaceSkin(base, fit, pose, false);
  // What it shows is of the side towards it: the other cheek lies behind the nose.
  const float towards = (glm::transpose(pose.Rotation()) * glm::vec3(0, 0, 1)).x > 0 ? 1.0F : -1.0F;
  const fsm::Image& colours = side.figure.colours;
  // The same skin in another light: a gain for each channel makes it match.
  glm::vec3 here(1), there(1);
  for (std::size_t i = 0; i < seen.at.size(); ++i) {
    if (seen.at[i] < 0.9F || front.facing[i] < 0.4F || places.facing[i] < 0.5F ||
        towards * front.across[i] < 5 || !InPhoto(colours, places.pixel[i])) {
      continue;
    }
    const std::uint8_t* p = &map.rgba[4 * i];
    here += glm::vec3(p[0], p[1], p[2]);
    there += ColourAt(colours, places.pixel[i]);
  }
  const glm::vec3 gain = glm::clamp(here / there, 0.4F, 2.5F);
  for (std::size_t i = 0; i < seen.at.size(); ++i) {
    if (places.facing[i] < 0.15F || !InPhoto(colours, places.pixel[i])) continue;
    const float can = glm::smoothstep(0.15F, 0.45F, places.facing[i]) *
                      glm::smoothstep(-4.0F, 12.0F, towards * front.across[i]);
    const float known = seen.at[i] * glm::smoothstep(0.2F, 0.5F, front.facing[i]);
    const float sum = known + (1 - known) * can;
    if (sum <= seen.at[i] * 0.01F || can <= 0) continue;
    const float part = (1 - known) * can / std::max(sum, 1e-4F);
    const glm::vec3 colour = glm::min(gain * ColourAt(colours, places.pixel[i]), 255.0F);
    for (std::size_t c = 0; c < 3; ++c) {
      map.rgba[4 * i + c] = static_cast<std::uint8_t>(
          glm::mix(static_cast<float>(map.rgba[4 * i + c]), colour[static_cast<int>(c)], part) +
          0.5F);
    }
    seen.at[i] = std::max(seen.at[i], sum);
  }
}

}  // namespace

Figure CutOut(const fsm::Image& photo, const std::vector<float>& person) {
  FloatImage mask(photo.width, photo.height);
  mask.at = person;
  const FloatImage opacity = Matte(photo, mask);
  Figure figure{WithoutBackground(photo, opacity), opacity};
  return figure;
}

TextureBake BakeTexture(const BaseHead& base, const FoundFace& face, const Fit& fit,
                        const fsm::Image& photo, const Figure& figure,
                        std::span<const SideView> sides, fsm::PhotoHead& set) {
  set.base = base.name;
  set.points = fit.points;
  set.smooth = fit.smooth;
  set.eyes = EyesAtRest(base, fit);
  TextureBake dress;
  dress.picture.width = 2 * kMapSide;
  dress.picture.height = kMapSide;
  dress.picture.rgba.assign(static_cast<std::size_t>(8 * kMapSide) * kMapSide, 255);

  const SkinPlaces places = PlaceSkin(base, fit, fit.pose, true);
  fsm::Image map;
  map.width = map.height = kMapSide;
  map.rgba.assign(static_cast<std::size_t>(4 * kMapSide) * kMapSide, 255);
  FloatImage seen(kMapSide, kMapSide), smooth(kMapSide, kMapSide);
  fsm::Image colours = figure.colours;
  const FloatImage filled = FillSmileFolds(
      face, 0.8F * glm::clamp(fit.expression.smile, 0.0F, 1.0F), fit.pose.PixelsPerMm(), colours);
  const bool open = fit.expression.jaw + fit.expression.parted > 0.1F;
  const Openings openings(face, fit.pose.PixelsPerMm(), open);
  std::vector<bool> skin(places.facing.size(), true);
  float face_texels = 0, face_seen = 0;
  for (std::size_t i = 0; i < places.facing.size(); ++i) {
    const glm::vec2 p = places.pixel[i];
    const bool inside = InPhoto(photo, p);
    face_texels += OnFront(places, i) ? 1.0F : 0.0F;
    // Near the head's outline the photo shows more of what lies beside it than of its skin.
    const float least = glm::mix(0.03F, 0.14F, places.aside[i]);
    if (!inside || places.facing[i] < least) continue;
    float weight = glm::smoothstep(least, least + 0.18F, places.facing[i]);
    const float part = openings.Skin(p);
    skin[i] = part >= 1;
    weight *= part;
    const glm::vec3 colour = SharpColourAt(colours, p);
    for (int c = 0; c < 3; ++c)
      map.rgba[4 * i + static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(colour[c] + 0.5F);
    seen.at[i] = weight;
    smooth.at[i] = filled.Between(p.x, p.y);
  }
  for (const SideView& side : sides) {
    if (!side.outline_only) LayOver(base, fit, side, places, map, seen);
  }
  for (std::size_t i = 0; i < places.facing.size(); ++i) {
    if (OnFront(places, i)) face_seen += seen.at[i];
  }
  set.saturation = Saturation(map, seen);
  dress.coverage = face_seen / std::max(face_texels, 1.0F);
  TakeFromOtherSide(skin, map, seen);
  PushPullInpaint(map, seen);
  EvenSmileShade(base, places, seen, 0.85F * glm::clamp(fit.expression.smile, 0.0F, 1.0F), map);
  GrainFromCheeks(smooth, map);
  FloatImage aside(kMapSide, kMapSide);
  aside.at = places.aside;
  AddGrain(seen, aside, kMapSide / 170, map);
  if (open) {
    RedLips(places.red, map);
    // Where lips that were apart now meet there is a dark line, reddish where the photo has colour.
    const glm::vec3 dark = glm::mix(glm::vec3(0.4F), glm::vec3(0.3F, 0.5F, 0.48F), set.saturation);
    for (std::size_t i = 0; i < places.off_seam.size(); ++i) {
      const float line = glm::smoothstep(1.0F, 0.1F, places.off_seam[i]);
      for (std::size_t c = 0; c < 3 && line > 0; ++c) {
        map.rgba[4 * i + c] =
            static_cast<std::uint8_t>(map.rgba[4 * i + c] * (1 - dark[static_cast<int>(c)] * line));
      }
    }
  }

  FloatImage face_seen_at = seen;
  for (std::size_t i = 0; i < face_seen_at.at.size(); ++i) {
    if (!OnFront(places, i)) face_seen_at.at[i] = 0;
  }
  // Smooth skin lies in soft folds, an old one creases.
  constexpr float kSmooth = 0.012F, kOld = 0.038F, kSoft = 0.3F;
  set.lined =
      glm::mix(kSoft, 1.0F,
               glm::clamp((Roughness(map, face_seen_at) - kSmooth) / (kOld - kSmooth), 0.0F, 1.0F));
  FloatImage likeness = SkinLikeness(map, face_seen_at);
  EndAtHair(places.up, likeness);
  for (std::size_t i = 0; i < likeness.at.size(); ++i) {
    map.rgba[4 * i + 3] = static_cast<std::uint8_t>(255 * likeness.at[i] + 0.5F);
  }

  const fsm::Image back = BehindFace(base, fit, figure);
  // An edge as wide as a pixel of a small photo would look blurred: screens show two and more
  // pixels to a millimetre.
  constexpr float kShown = 2;
  const float steep = glm::clamp(kShown / fit.pose.PixelsPerMm(), 1.0F, 3.0F);
  for (int y = 0; y < kMapSide; ++y) {
    for (int x = 0; x < kMapSide; ++x) {
      std::uint8_t* left = &dress.picture.rgba[4 * (static_cast<std::size_t>(y) * 2 * kMapSide +
                                                    static_cast<std::size_t>(x))];
      std::copy_n(&map.rgba[4 * MapIndex(x, y)], 4, left);
      const glm::vec2 p = (glm::vec2(x, y) + 0.5F) / static_cast<float>(kMapSide) *
                          glm::vec2(photo.width, photo.height);
      const glm::vec3 colour = SharpColourAt(back, p);
      std::uint8_t* right = left + 4 * kMapSide;
      for (int c = 0; c < 3; ++c) right[c] = static_cast<std::uint8_t>(colour[c] + 0.5F);
      const float opacity =
          glm::clamp(0.5F + steep * (SmoothAt(figure.opacity, p) - 0.5F), 0.0F, 1.0F);
      right[3] = static_cast<std::uint8_t>(255 * opacity + 0.5F);
    }
  }
  // Half a texel within, so that the halves do not run into each other.
  constexpr float kHalf = 0.25F / kMapSide;
  set.skin_low = {kHalf, 1};
  set.skin_high = {0.5F - kHalf, 0};
  MakeSheet(base, fit, figure, set);
  for (const SideView& side : sides) {
    if (side.outline_only) continue;
    set.also_seen.push_back(glm::transpose(side.view.pose.Rotation()) * glm::vec3(0, 0, 1));
  }
  SampleEyes(face, fit, photo, set);
  PaintEyes(base, face, fit, photo, dress.picture, set);
  SampleMouth(face, photo, set);
  set.glasses = BarOnNose(face, photo) > kGlasses;
  return dress;
}

}  // namespace facefit
