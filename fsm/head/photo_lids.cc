#include "fsm/head/photo_lids.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>
#include <optional>
#include <utility>

#include "fsm/base/smooth_step.h"
#include "fsm/head/skin_membrane.h"

namespace fsm {
namespace {

/// A place of the skin near an eye and its appearance in the photo.
struct PhotoSpot {
  glm::vec2 position;  ///< on the face, millimetres
  glm::vec2 texcoord;  ///< in the photo
  glm::vec3 screen;
  float lit;  ///< brightness of typical skin with this normal
};

/// Returns means of `spots`, weighted by the distance from `at`, which falls off over `reach` mm.
PhotoSpot MeanAround(std::span<const PhotoSpot> spots, glm::vec2 at, float reach) {
  PhotoSpot mean{at, glm::vec2(0), glm::vec3(0), 0};
  float weight = 1e-9f;
  for (const PhotoSpot& spot : spots) {
    const glm::vec2 offset = (spot.position - at) / reach;
    const float w = std::exp(-glm::dot(offset, offset)) + 1e-8f;
    mean.texcoord += w * spot.texcoord;
    mean.screen += w * spot.screen;
    mean.lit += w * spot.lit;
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
    const float offset = p.x - x;
    const float w = std::exp(-offset * offset) + 1e-8f;
    sum += w * p.y;
    weight += w;
  }
  return sum / weight;
}

/// The affine map from points on the face to texture coordinates, fitted to spots.
struct PhotoPlane {
  glm::vec2 centroid{0}, texcoord{0};
  glm::mat2 slope{0};
  glm::vec2 operator()(glm::vec2 p) const { return texcoord + slope * (p - centroid); }
};

PhotoPlane PhotoByFace(std::span<const PhotoSpot> spots) {
  PhotoSpot mean{glm::vec2(0), glm::vec2(0), glm::vec3(0), 0};
  for (const PhotoSpot& spot : spots) {
    mean.position += spot.position / static_cast<float>(spots.size());
    mean.texcoord += spot.texcoord / static_cast<float>(spots.size());
  }
  glm::mat2 spread(1e-6f), both(0);
  for (const PhotoSpot& spot : spots) {
    spread += glm::outerProduct(spot.position - mean.position, spot.position - mean.position);
    both += glm::outerProduct(spot.texcoord - mean.texcoord, spot.position - mean.position);
  }
  return {mean.position, mean.texcoord, both * glm::inverse(spread)};
}

/// What a photo shows around one eye.
struct EyeSurroundings {
  std::vector<PhotoSpot> around, below;
  std::vector<glm::vec2> upper_rim, lower_rim;  ///< margins of the lids, none of them empty
  float rim_from, rim_to;                       ///< x of the corners
  float lowest;                                 ///< y of the lower margin
  PhotoPlane photo_by_face, grain_by_face;
  glm::vec3 skin_below;
  SkinMembrane eyeless;
};

/// Returns nothing if an eye has no lids.
std::optional<EyeSurroundings> MeasureEye(const PhotoMapping& mapping, const PhotoSkin& skin,
                                          bool glasses, const Features::PhotoLid& lid,
                                          const FaceLight& light, Side side) {
  std::vector<SkinSample> samples;
  std::vector<PhotoSpot> around;
  std::vector<glm::vec2> rims, upper_rim, lower_rim;
  for (std::size_t i = 0; i < skin.weights.size(); ++i) {
    const BakeWeights& weights = skin.weights[i];
    if (weights.eye != side) continue;
    const glm::vec2 at(skin.open.position[i]);
    const glm::vec3 screen = PhotoColour(mapping.photo, mapping.texcoord[i]);
    const bool above = weights.lid_upper >= weights.lid_lower;
    samples.push_back({at, screen, above, 1, false});
    if (weights.lid_upper + weights.lid_lower > lid.held.margin) rims.push_back(at);
    if (weights.lid_upper > lid.held.margin) upper_rim.push_back(at);
    if (weights.lid_lower > lid.held.margin) lower_rim.push_back(at);
    around.push_back({at, mapping.texcoord[i], screen, light.On(skin.open.normal[i])});
  }
  if (upper_rim.empty() || lower_rim.empty()) return {};
  std::vector<PhotoSpot> below = around;
  std::erase_if(below, [&](const PhotoSpot& spot) {
    return spot.position.y > HeightAt(lower_rim, spot.position.x) - lid.skin_below.margin;
  });
  for (SkinSample& s : samples) {
    // Along the margins the photo shows lashes.
    float away = 100;
    for (const glm::vec2 rim : rims) away = std::min(away, glm::distance(rim, s.position));
    s.beside_lid = away < (glasses ? lid.near.glasses : lid.near.plain);
    s.confidence = (s.above ? lid.past_lashes.upper : lid.past_lashes.lower).Ramp(away);
  }
  // Only skin is bright above an eye, unless glasses reflect light there.
  DownweightOutliers(samples, glasses ? lid.odd_skin.glasses : lid.odd_skin.plain);
  // Skin below an eye is thin and bluish: half of the hue is the face's. Lenses add their own.
  const glm::vec3 skin_below = MeanBelow(samples);
  const glm::vec3 face_hue = light.skin() / ScreenBrightness(light.skin());
  const float of_face = glasses ? lid.hue.face_glasses : lid.hue.face;
  const auto [first, last] = std::ranges::minmax(upper_rim, {}, &glm::vec2::x);
  const float lowest = std::ranges::min(lower_rim, {}, &glm::vec2::y).y;
  const PhotoPlane photo_by_face = PhotoByFace(around);
  const PhotoPlane grain_by_face = below.empty() ? PhotoPlane{} : PhotoByFace(below);
  return EyeSurroundings{std::move(around),
                         std::move(below),
                         std::move(upper_rim),
                         std::move(lower_rim),
                         first.x,
                         last.x,
                         lowest,
                         photo_by_face,
                         grain_by_face,
                         glm::mix(skin_below, ScreenBrightness(skin_below) * face_hue, of_face),
                         SkinMembrane(samples)};
}

/// The lids of one eye.
class LidPainter {
 public:
  LidPainter(const PhotoMapping& mapping, const PhotoSkin& skin, bool glasses,
             const Features::PhotoLid& lid, const FaceLight& light, Side side,
             const EyeSurroundings& eye)
      : mapping_(mapping),
        skin_(skin),
        glasses_(glasses),
        lid_(lid),
        light_(light),
        side_(side),
        eye_(eye) {}

  void Paint(std::vector<ShutLid>& lids) const {
    for (std::uint32_t i = 0; i < skin_.weights.size(); ++i) {
      const BakeWeights& weights = skin_.weights[i];
      if (weights.eye == side_) lids.push_back(weights.lid_upper > 0 ? Upper(i) : Lower(i));
    }
  }

 private:
  /// Returns the position along the eye, -1..1.
  float Along(glm::vec2 at) const {
    return (2 * at.x - eye_.rim_from - eye_.rim_to) / std::max(eye_.rim_to - eye_.rim_from, 1.0f);
  }
  /// Returns how far outward a place is, 0..1: lashes are densest and longest there.
  float Outward(glm::vec2 at) const { return lid_.outward.Ramp(Along(at) * SignOf(side_)); }

  /// Returns skin under lashes that absorb `dark` of its light, 0..1; with colour they are brown.
  glm::vec3 Lashed(glm::vec3 skin, float dark) const {
    const float chroma = std::max(skin.r - skin.b, 0.0f) / std::max(skin.r, 0.01f);
    const glm::vec3 brown = glm::vec3(1) + std::min(2 * chroma, 1.0f) * lid_.lash_brown;
    return skin * glm::pow(glm::vec3(1 - dark), brown);
  }

  /// Returns skin that gets less light, which has passed through skin.
  glm::vec3 Shaded(glm::vec3 skin, float light) const {
    const float chroma = std::clamp(1 - skin.b / std::max(skin.r, 0.05f), 0.0f, 1.0f);
    return skin * light * (1.0f + (1 - light) * chroma * lid_.hue.through_skin);
  }

  /// Returns `colour` with the hue of `skin`, which lies below the eye: a lid has the same hue,
  /// while the photo may show reflections of glasses, a rim or lashes above the eye. Shaded skin is
  /// redder, because light has passed through it.
  glm::vec3 OfHue(glm::vec3 colour, glm::vec3 skin) const {
    const float dim = ScreenBrightness(colour) / ScreenBrightness(skin);
    const float red = lid_.hue.redder * (skin.r - skin.b) / std::max(skin.r, 0.01f);
    const glm::vec3 shaded =
        skin * glm::pow(glm::vec3(dim), glm::vec3(1 - red, 1 + 0.4f * red, 1 + 0.4f * red));
    return glm::mix(colour, shaded, lid_.hue.below);
  }

  /// Returns the lid's colour: where the lid begins it is as deep as the skin around it; lower down
  /// the eyeball bulges it into the light.
  glm::vec3 Skin(std::uint32_t i, glm::vec2 at) const {
    const auto& socket = lid_.socket;
    const auto& behind_glasses = lid_.glasses;
    const glm::vec3 deep = OfHue(eye_.eyeless.At(at), eye_.skin_below);
    const float rim = HeightAt(eye_.upper_rim, at.x), meet = HeightAt(eye_.lower_rim, at.x);
    const glm::vec2 below(at.x, meet - lid_.skin_below.lit);
    const float turned = light_.On(skin_.shut.normal[i]) /
                         MeanAround(eye_.below, below, lid_.skin_below.lit_reach).lit;
    const glm::vec3 lit = socket.light * turned * OfHue(eye_.eyeless.At(below), eye_.skin_below);
    const float down = SmoothStep(rim + socket.fold, meet, at.y);
    // The frame of glasses shades the skin behind it.
    if (glasses_) {
      const glm::vec3 skin = glm::mix(deep, eye_.skin_below, behind_glasses.below);
      return glm::mix(behind_glasses.light * skin, lit, behind_glasses.rim * down);
    }
    // A lid in a deep, dark socket does not come out of the shade fully.
    const float out = glm::mix(socket.out, 1.0f,
                               socket.deep.Ramp(ScreenBrightness(deep) / ScreenBrightness(lit)));
    return glm::mix(deep, lit, out * socket.lit.At(down));
  }

  static float GrainLight(const PhotoSpot& skin) {
    return std::max(ScreenBrightness(skin.screen), 0.02f);
  }

  ShutLid Lower(std::uint32_t i) const {
    const auto& lashes = lid_.lower_lashes;
    // The lashes of the upper lid lie over the margin of the lower lid.
    const glm::vec2 at(skin_.shut.position[i]);
    const float outward = Outward(at);
    const float held = skin_.weights[i].lid_lower;
    const float lashed = SmoothStep(lashes.held - lashes.longer * outward, 1.0f, held);
    // The wet margin of the open eye is hidden.
    const float rim = lashes.rim_held.Ramp(held);
    return {.vertex = i,
            .colour = FromScreen(Lashed(Skin(i, at), lashes.dark * lashed)),
            .weight = std::max(lashes.rim * rim, lashes.skin.At(outward) * lashed),
            .grain_at = mapping_.texcoord[i],
            .grain_light = GrainLight(MeanAround(eye_.around, at, lid_.grain.reach_lower)),
            .slide = glm::vec2(0)};
  }

  ShutLid Upper(std::uint32_t i) const {
    const glm::vec2 at(skin_.shut.position[i]);
    const float held = skin_.weights[i].lid_upper;
    const float rim = HeightAt(eye_.upper_rim, at.x), meet = HeightAt(eye_.lower_rim, at.x);
    const float inside = std::min(Along(at) * Along(at), 1.0f);
    // A soft furrow where the lid slides under the skin.
    const float deep = (at.y - rim - lid_.furrow.above) / lid_.furrow.width;
    const float furrow = 1 - lid_.furrow.dark * (1 - inside) * std::exp(-deep * deep);
    // The lid turns away at its ends, and its lashes shade it.
    const float shade =
        (1 - lid_.shade.ends * inside) * (1 - lid_.shade.rim * lid_.shade.lashes.Ramp(at.y - meet));
    const glm::vec3 skin = Shaded(Skin(i, at), furrow * shade);
    const float lashes = lid_.upper_lashes.dark.At(Outward(at)) * lid_.upper_lashes.held.Ramp(held);
    const float height = std::max(at.y - eye_.lowest, 0.0f);
    const float down = glasses_ ? Folded(height) : std::abs(lid_.grain.highest - height);
    const glm::vec2 source(at.x, eye_.lowest - lid_.grain.below - down);
    // Close to a rim of glasses skin darkens within millimetres, which is no grain.
    const PhotoSpot wide =
        MeanAround(eye_.below, source, glasses_ ? lid_.grain.reach_glasses : lid_.grain.reach);
    return {.vertex = i,
            .colour = FromScreen(glm::clamp(Lashed(skin, lashes), 0.0f, 1.0f)),
            .weight = Opacity(at, rim, skin) * lid_.held.fades_in.Ramp(held),
            .grain_at = eye_.grain_by_face(source),
            .grain_light = GrainLight(wide),
            .slide = eye_.photo_by_face.slope * (at - glm::vec2(skin_.open.position[i]))};
  }

  /// Folds a distance back and forth into the narrow strip of skin between an eye and a rim of
  /// glasses.
  float Folded(float away) const {
    const float strip = lid_.grain.strip;
    return strip - std::abs(std::fmod(away, 2 * strip) - strip);
  }

  /// Returns the lid's opacity: from a little above the eye's margin on, and over the old lashes.
  float Opacity(glm::vec2 at, float rim, glm::vec3 skin) const {
    const float beyond =
        std::max(eye_.rim_from - at.x, at.x - eye_.rim_to);  // past the corners, mm
    const float lid = (rim + lid_.cover.above).Ramp(at.y) * lid_.cover.past_corners.Ramp(beyond);
    const float shown =
        ScreenBrightness(MeanAround(eye_.around, at, lid_.open_lashes.reach).screen) /
        ScreenBrightness(skin);
    // A reflection on a lens lies in front of the lid.
    if (glasses_) return lid * lid_.cover.reflection.Ramp(shown);
    const float dark = lid_.open_lashes.dark.Ramp(1 - shown);
    return std::max(lid, lid_.open_lashes.hidden * dark *
                             (rim + lid_.open_lashes.above).Ramp(at.y) *
                             lid_.open_lashes.past_corners.Ramp(beyond));
  }

  const PhotoMapping& mapping_;
  const PhotoSkin& skin_;
  const bool glasses_;
  const Features::PhotoLid& lid_;
  const FaceLight& light_;
  const Side side_;
  const EyeSurroundings& eye_;
};

}  // namespace

glm::vec3 PhotoColour(const Image& photo, glm::vec2 texcoord) {
  const auto at = [](float share, int size) {
    return std::clamp(static_cast<int>(share * static_cast<float>(size)), 0, size - 1);
  };
  const std::uint8_t* p =
      &photo.rgba[4 * photo.Index(at(texcoord.x, photo.width), at(texcoord.y, photo.height))];
  return glm::vec3(p[0], p[1], p[2]) / 255.0f;
}

FaceLight FitFaceLight(const PhotoMapping& mapping, const SkinSurface& open) {
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
  const Features::PhotoLid& lid = features.photo_lid;
  std::vector<ShutLid> lids;
  for (const Side side : kSides) {
    const auto eye = MeasureEye(mapping, skin, glasses, lid, light, side);
    if (eye) LidPainter(mapping, skin, glasses, lid, light, side, *eye).Paint(lids);
  }
  return lids;
}

}  // namespace fsm
