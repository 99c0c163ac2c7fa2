#include "fsm/head/photo_lids.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "fsm/base/smooth_step.h"
#include "fsm/head/skin_membrane.h"

namespace fsm {
namespace {

/// A place of the skin near an eye and its appearance in the photo.
struct PhotoSpot {
  glm::vec2 at;        ///< on the face, millimetres
  glm::vec2 texcoord;  ///< in the photo
  glm::vec3 screen;
  float lit;  ///< brightness of typical skin with this normal
};

/// Returns means of `places`, weighted by the distance from `at`, which falls off over `reach` mm.
PhotoSpot MeanAround(std::span<const PhotoSpot> places, glm::vec2 at, float reach) {
  PhotoSpot mean{at, glm::vec2(0), glm::vec3(0), 0};
  float weight = 1e-9f;
  for (const PhotoSpot& l : places) {
    const glm::vec2 off = (l.at - at) / reach;
    const float w = std::exp(-glm::dot(off, off)) + 1e-8f;
    mean.texcoord += w * l.texcoord;
    mean.screen += w * l.screen;
    mean.lit += w * l.lit;
    weight += w;
  }
  mean.texcoord /= weight;
  mean.screen /= weight;
  mean.lit /= weight;
  return mean;
}

/// Returns the height of a line of points at x; 0 if there are none.
float HeightAt(std::span<const glm::vec2> line, float x) {
  float sum = 0, weight = 1e-9f;
  for (const glm::vec2 p : line) {
    const float off = p.x - x;
    const float w = std::exp(-off * off) + 1e-8f;
    sum += w * p.y;
    weight += w;
  }
  return sum / weight;
}

/// What the painting of lids has beside features.txt. Lengths are in millimetres, `held` is the
/// part that a vertex has in a lid's rotation (1 at the margin), and brightness is on the screen,
/// 0..1. Pairs are the ends of a SmoothStep.
constexpr struct {
  float margin_held = 0.95f;                       // a vertex of the lid's margin
  float near_margin = 8, near_margin_glasses = 6;  // skin that tells the colour of the lid
  glm::vec2 past_upper_lashes{1, 3}, past_lower_lashes{0.6f, 1.6f};  // from the margin
  float odd_skin = 0.65f, odd_skin_glasses = 0.5f;  // brightness below which it is no skin
  float below_margin = 0.5f;                        // skin under the eye begins so far below
  glm::vec2 outward{-0.8f, 0.7f};                   // along the eye, -1..1
  float lit_below = 3, lit_reach = 4;               // where skin under the eye is looked at
  float fold = 2;                                   // from the margin of the open eye upward
  glm::vec2 deep_socket{0.4f, 0.8f};                // brightness relative to lit skin
  float lower_lashes_held = 0.96f, lower_lashes_longer = 0.08f;  // from here on, outward sooner
  glm::vec2 lower_rim_held{0.92f, 0.97f}, upper_lashes_held{0.96f, 1};
  float lower_grain_reach = 2;
  glm::vec2 lash_shade{2, 0};  // above the line where the lids meet
  float grain_below = 1.5f;    // under the lowest point of the eye
  float grain_reach = 4, grain_reach_glasses = 1.2f;
  float highest = 14;  // most that a lid lies above the lower margin
  float strip = 5;     // of skin between an eye and glasses
  glm::vec2 fades_in_held{0.02f, 0.2f};
  glm::vec2 past_corners{3, 0}, lashes_past_corners{6, 3};
  float shown_reach = 1.5f;
  glm::vec2 reflection{1.7f, 1.3f},
      lash_dark{0.05f, 0.2f};          // brightness relative to the lid, and less
  glm::vec2 lashes_above{7.5f, 5.5f};  // the margin of the open eye
} kLid{};

/// Folds a distance back and forth into the narrow strip of skin between an eye and a rim of
/// glasses.
float Folded(float away) {
  const float part = std::fmod(away, 2 * kLid.strip);
  return kLid.strip - std::abs(part - kLid.strip);
}

/// The affine map from points on the face to texture coordinates, fitted to spots.
struct PhotoPlane {
  glm::vec2 at{0}, texcoord{0};  ///< centroid
  glm::mat2 slope{0};
  glm::vec2 operator()(glm::vec2 p) const { return texcoord + slope * (p - at); }
};

PhotoPlane PhotoByFace(std::span<const PhotoSpot> all) {
  PhotoSpot mean{glm::vec2(0), glm::vec2(0), glm::vec3(0), 0};
  for (const PhotoSpot& l : all) {
    mean.at += l.at / static_cast<float>(all.size());
    mean.texcoord += l.texcoord / static_cast<float>(all.size());
  }
  glm::mat2 spread(1e-6f), both(0);
  for (const PhotoSpot& l : all) {
    spread += glm::outerProduct(l.at - mean.at, l.at - mean.at);
    both += glm::outerProduct(l.texcoord - mean.texcoord, l.at - mean.at);
  }
  return {mean.at, mean.texcoord, both * glm::inverse(spread)};
}

/// The lids of one eye.
class LidPainter {
 public:
  LidPainter(const PhotoMapping& mapping, const PhotoSkin& skin, bool glasses,
             const Features& features, const FaceLight& light, Side side)
      : mapping_(mapping),
        skin_(skin),
        glasses_(glasses),
        features_(features),
        light_(light),
        side_(side) {
    // Collects what the photo shows around the eye, and the margins of the lids.
    std::vector<SkinSample> samples;
    std::vector<glm::vec2> rims;
    for (std::size_t i = 0; i < skin.weights.size(); ++i) {
      const BakeWeights& weights = skin.weights[i];
      if (weights.eye != side) continue;
      const glm::vec2 at(skin.open.position[i]);
      const glm::vec3 screen = PhotoColour(mapping.photo, mapping.texcoord[i]);
      const bool above = weights.lid_upper >= weights.lid_lower;
      samples.push_back({at, screen, above, 1, false});
      if (weights.lid_upper + weights.lid_lower > kLid.margin_held) rims.push_back(at);
      if (weights.lid_upper > kLid.margin_held) upper_rim_.push_back(at);
      if (weights.lid_lower > kLid.margin_held) lower_rim_.push_back(at);
      around_.push_back({at, mapping.texcoord[i], screen, light.On(skin.open.normal[i])});
    }
    if (!HasLids()) return;
    const auto [first, last] = std::ranges::minmax(upper_rim_, {}, &glm::vec2::x);
    rim_from_ = first.x;
    rim_to_ = last.x;
    lowest_ = std::ranges::min(lower_rim_, {}, &glm::vec2::y).y;
    photo_by_face_ = PhotoByFace(around_);
    below_ = around_;
    std::erase_if(below_, [&](const PhotoSpot& l) {
      return l.at.y > HeightAt(lower_rim_, l.at.x) - kLid.below_margin;
    });
    if (!below_.empty()) grain_by_face_ = PhotoByFace(below_);
    for (SkinSample& s : samples) {
      // Along the margins the photo shows lashes.
      float away = 100;
      for (const glm::vec2 rim : rims) away = std::min(away, glm::distance(rim, s.at));
      s.near = away < (glasses ? kLid.near_margin_glasses : kLid.near_margin);
      s.known = SmoothStep(s.above ? kLid.past_upper_lashes : kLid.past_lower_lashes, away);
    }
    // Only skin is bright above an eye, unless glasses reflect light there.
    DoubtOddSkin(samples, glasses ? kLid.odd_skin_glasses : kLid.odd_skin);
    // Skin below an eye is thin and bluish: half of the hue is the face's. Lenses add their own.
    skin_below_ = MeanBelow(samples);
    const glm::vec3 face_hue = light.skin() / ScreenBrightness(light.skin());
    skin_below_ = glm::mix(
        skin_below_, ScreenBrightness(skin_below_) * face_hue,
        glasses ? features_.photo_lid_face_hue.glasses : features_.photo_lid_face_hue.plain);
    eyeless_.emplace(samples);
  }

  bool HasLids() const { return !upper_rim_.empty() && !lower_rim_.empty(); }

  void Paint(std::vector<ShutLid>& lids) const {
    for (std::uint32_t i = 0; i < skin_.weights.size(); ++i) {
      const BakeWeights& weights = skin_.weights[i];
      if (weights.eye == side_) lids.push_back(weights.lid_upper > 0 ? Upper(i) : Lower(i));
    }
  }

 private:
  /// Returns the position along the eye, -1..1.
  float Along(glm::vec2 at) const {
    return (2 * at.x - rim_from_ - rim_to_) / std::max(rim_to_ - rim_from_, 1.0f);
  }
  /// Returns how far outward a place is, 0..1: lashes are densest and longest there.
  float Outward(glm::vec2 at) const { return SmoothStep(kLid.outward, Along(at) * SignOf(side_)); }

  /// Returns skin under lashes that absorb `dark` of its light, 0..1; with colour they are brown.
  glm::vec3 Lashed(glm::vec3 skin, float dark) const {
    const float chroma = std::max(skin.r - skin.b, 0.0f) / std::max(skin.r, 0.01f);
    const glm::vec3 brown = glm::vec3(1) + std::min(2 * chroma, 1.0f) * features_.photo_lash_brown;
    return skin * glm::pow(glm::vec3(1 - dark), brown);
  }

  /// Returns skin that gets less light, which has passed through skin.
  glm::vec3 Shaded(glm::vec3 skin, float light) const {
    const float chroma = std::clamp(1 - skin.b / std::max(skin.r, 0.05f), 0.0f, 1.0f);
    return skin * light * (1.0f + (1 - light) * chroma * features_.photo_lid_shade_hue);
  }

  /// Returns `colour` with the hue of `skin`, which lies below the eye: a lid has the same hue,
  /// while the photo may show reflections of glasses, a rim or lashes above the eye. Shaded skin is
  /// redder, because light has passed through it.
  glm::vec3 OfHue(glm::vec3 colour, glm::vec3 skin) const {
    const float dim = ScreenBrightness(colour) / ScreenBrightness(skin);
    const float red = features_.photo_lid_hue.redder * (skin.r - skin.b) / std::max(skin.r, 0.01f);
    const glm::vec3 shaded =
        skin * glm::pow(glm::vec3(dim), glm::vec3(1 - red, 1 + 0.4f * red, 1 + 0.4f * red));
    return glm::mix(colour, shaded, features_.photo_lid_hue.below);
  }

  /// Returns the lid's colour: where the lid begins it is as deep as the skin around it; lower down
  /// the eyeball bulges it into the light.
  glm::vec3 Skin(std::uint32_t i, glm::vec2 at) const {
    const glm::vec3 deep = OfHue(eyeless_->At(at), skin_below_);
    const float rim = HeightAt(upper_rim_, at.x), meet = HeightAt(lower_rim_, at.x);
    const glm::vec2 below(at.x, meet - kLid.lit_below);
    const float turned =
        light_.On(skin_.shut.normal[i]) / MeanAround(below_, below, kLid.lit_reach).lit;
    const glm::vec3 lit =
        features_.photo_lid_in_socket.light * turned * OfHue(eyeless_->At(below), skin_below_);
    const float down = SmoothStep(rim + kLid.fold, meet, at.y);
    // The frame of glasses shades the skin behind it.
    if (glasses_) {
      const glm::vec3 skin = glm::mix(deep, skin_below_, features_.photo_lid_behind_glasses.below);
      return glm::mix(features_.photo_lid_behind_glasses.light * skin, lit,
                      features_.photo_lid_behind_glasses.rim * down);
    }
    // A lid in a deep, dark socket does not come out of the shade fully.
    const float out =
        glm::mix(features_.photo_lid_in_socket.out, 1.0f,
                 SmoothStep(kLid.deep_socket, ScreenBrightness(deep) / ScreenBrightness(lit)));
    return glm::mix(deep, lit, out * Lerp(features_.photo_lid_in_socket.lit, down));
  }

  static float GrainLight(const PhotoSpot& skin) {
    return std::max(ScreenBrightness(skin.screen), 0.02f);
  }

  ShutLid Lower(std::uint32_t i) const {
    // The lashes of the upper lid lie over the margin of the lower lid.
    const glm::vec2 at(skin_.shut.position[i]);
    const float outward = Outward(at);
    const float held = skin_.weights[i].lid_lower;
    const float lashes =
        SmoothStep(kLid.lower_lashes_held - kLid.lower_lashes_longer * outward, 1.0f, held);
    // The wet margin of the open eye is hidden.
    const float rim = SmoothStep(kLid.lower_rim_held, held);
    return {.vertex = i,
            .colour = FromScreen(Lashed(Skin(i, at), features_.photo_lower_lashes.dark * lashes)),
            .weight = std::max(features_.photo_lower_lashes.rim * rim,
                               Linear(features_.photo_lower_lashes.skin, outward) * lashes),
            .grain_at = mapping_.texcoord[i],
            .grain_light = GrainLight(MeanAround(around_, at, kLid.lower_grain_reach)),
            .slide = glm::vec2(0)};
  }

  ShutLid Upper(std::uint32_t i) const {
    const glm::vec2 at(skin_.shut.position[i]);
    const float held = skin_.weights[i].lid_upper;
    const float rim = HeightAt(upper_rim_, at.x), meet = HeightAt(lower_rim_, at.x);
    const float inside = std::min(Along(at) * Along(at), 1.0f);
    // A soft furrow where the lid slides under the skin.
    const float deep =
        (at.y - rim - features_.photo_lid_furrow.above) / features_.photo_lid_furrow.width;
    const float furrow =
        1 - features_.photo_lid_furrow.dark * (1 - inside) * std::exp(-deep * deep);
    // The lid turns away at its ends, and its lashes shade it.
    const float shade =
        (1 - features_.photo_lid_shade.ends * inside) *
        (1 - features_.photo_lid_shade.rim * SmoothStep(kLid.lash_shade, at.y - meet));
    const glm::vec3 skin = Shaded(Skin(i, at), furrow * shade);
    const float lashes = Linear(features_.photo_upper_lashes, Outward(at)) *
                         SmoothStep(kLid.upper_lashes_held, held);
    const float height = std::max(at.y - lowest_, 0.0f);
    const float down = glasses_ ? Folded(height) : std::abs(kLid.highest - height);
    const glm::vec2 source(at.x, lowest_ - kLid.grain_below - down);
    // Close to a rim of glasses skin darkens within millimetres, which is no grain.
    const PhotoSpot wide =
        MeanAround(below_, source, glasses_ ? kLid.grain_reach_glasses : kLid.grain_reach);
    return {.vertex = i,
            .colour = FromScreen(glm::clamp(Lashed(skin, lashes), 0.0f, 1.0f)),
            .weight = Opacity(at, rim, skin) * SmoothStep(kLid.fades_in_held, held),
            .grain_at = grain_by_face_(source),
            .grain_light = GrainLight(wide),
            .slide = photo_by_face_.slope * (at - glm::vec2(skin_.open.position[i]))};
  }

  /// Returns the lid's opacity: from a little above the eye's margin on, and over the old lashes.
  float Opacity(glm::vec2 at, float rim, glm::vec3 skin) const {
    const float beyond = std::max(rim_from_ - at.x, at.x - rim_to_);  // past the corners, mm
    const glm::vec2 above = rim + features_.photo_lid_above;
    const float lid = SmoothStep(above.x, above.y, at.y) * SmoothStep(kLid.past_corners, beyond);
    const float shown =
        ScreenBrightness(MeanAround(around_, at, kLid.shown_reach).screen) / ScreenBrightness(skin);
    // A reflection on a lens lies in front of the lid.
    if (glasses_) return lid * SmoothStep(kLid.reflection, shown);
    const float dark = SmoothStep(kLid.lash_dark, 1 - shown);
    return std::max(lid, features_.photo_lashes_hidden * dark *
                             SmoothStep(rim + kLid.lashes_above, at.y) *
                             SmoothStep(kLid.lashes_past_corners, beyond));
  }

  const PhotoMapping& mapping_;
  const PhotoSkin& skin_;
  const bool glasses_;
  const Features& features_;
  const FaceLight& light_;
  Side side_;
  std::vector<PhotoSpot> around_, below_;
  std::vector<glm::vec2> upper_rim_, lower_rim_;
  float rim_from_ = 0, rim_to_ = 0, lowest_ = 0;
  PhotoPlane photo_by_face_, grain_by_face_;
  glm::vec3 skin_below_{0};
  std::optional<SkinMembrane> eyeless_;
};

}  // namespace

glm::vec3 PhotoColour(const Image& photo, glm::vec2 texcoord) {
  const auto at = [](float part, int size) {
    return std::clamp(static_cast<int>(part * static_cast<float>(size)), 0, size - 1);
  };
  const std::uint8_t* p =
      &photo.rgba[4 * photo.Index(at(texcoord.x, photo.width), at(texcoord.y, photo.height))];
  return glm::vec3(p[0], p[1], p[2]) / 255.0f;
}

FaceLight FitFaceLight(const PhotoMapping& mapping, const SkinPose& open) {
  constexpr float kSquarely = 0.3f, kFront = 45;  // of the normal's z; mm, without neck and ears
  std::vector<FaceLight::Patch> seen;
  for (std::size_t i = 0; i < open.normal.size(); ++i) {
    const bool squarely = open.normal[i].z > kSquarely && open.position[i].z > kFront;
    if (mapping.weight[i] <= 0 || !squarely) continue;
    seen.push_back({open.normal[i], PhotoColour(mapping.photo, mapping.texcoord[i])});
  }
  return FaceLight(seen);
}

std::vector<ShutLid> PaintLids(const PhotoMapping& mapping, const PhotoSkin& skin, bool glasses,
                               const Features& features, const FaceLight& light) {
  std::vector<ShutLid> lids;
  for (const Side side : kSides) {
    const LidPainter painter(mapping, skin, glasses, features, light, side);
    if (painter.HasLids()) painter.Paint(lids);
  }
  return lids;
}

}  // namespace fsm
