#include "face_fit/bake/feature_colours.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <vector>

#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "face_fit/image/plane.h"
#include "face_fit/image/resample.h"
#include "face_fit/tables/photo_look.h"
#include "fsm/image/colour_space.h"

namespace facefit {
namespace {

// Where an eye's colours are sampled, divided by the distance of its corners: half size of a
// rectangle about their middle, step, and distance from the lids with their lashes and shade.
constexpr float kHalfWidth = 0.5F, kHalfHeight = 0.25F, kSampleStep = 0.02F, kFromLids = 0.05F;
constexpr std::size_t kRanksTogether = 7, kMinSamples = 8;
// Plausible linear light of irises and whites.
constexpr fsm::Range kIrisLight{0.0005F, 0.6F}, kWhiteLight{0.04F, 0.8F};

/// Returns the mean colour around a rank of brightness, 0..1; `otherwise` if there are too few.
glm::vec3 Typical(std::vector<glm::vec3> colours, float rank, glm::vec3 otherwise) {
  if (colours.size() < kMinSamples) return otherwise;
  std::ranges::sort(colours, {}, Brightness);
  const auto middle = static_cast<std::size_t>(rank * static_cast<float>(colours.size() - 1));
  const std::size_t first = middle < kRanksTogether / 2 ? 0 : middle - kRanksTogether / 2;
  glm::vec3 sum(0);
  for (std::size_t i = first; i < first + kRanksTogether; ++i) {
    sum += colours[std::min(i, colours.size() - 1)];
  }
  return sum / float{kRanksTogether};
}

/// Returns the mean brightness of the skin, linear.
float SkinLight(const FoundFace& face, const fsm::Image& photo) {
  float light = 0;
  for (const PointIndex i : point::kBareSkin) {
    light += Brightness(fsm::SrgbToLinear(ColourAt(photo, face.PixelOf(i)) / 255.0F)) /
             point::kBareSkin.size();
  }
  return light;
}

/// Returns the linear colour with which an iris is drawn. The gain makes up for pupil and rim,
/// which darken it. In weak light brightness is raised for all channels alike: raised one by one, a
/// brown iris would turn grey. `seen`: 0..255, likewise below.
glm::vec3 DrawnIris(glm::vec3 seen) {
  const auto& look = PhotoLook().iris;
  const glm::vec3 bright = fsm::SrgbToLinear(seen / 255.0F) * look.gain;
  return kIrisLight.Clamp(bright *
                          std::max(1.0F, look.darkest / std::max(Brightness(bright), 1e-4F)));
}

/// The same of a white. Whites are paler than the photo shows them, but keep the hue of the light,
/// and even in shade they are not much darker than the skin around.
glm::vec3 DrawnWhite(glm::vec3 seen, float skin_light) {
  const auto& look = PhotoLook().white;
  const glm::vec3 linear = fsm::SrgbToLinear(seen / 255.0F);
  const glm::vec3 pale = glm::mix(linear, glm::vec3(Brightness(linear)), look.greyed_share);
  const float least = look.darkest_by_skin * skin_light;
  return kWhiteLight.Clamp(pale * std::max(1.0F, least / std::max(Brightness(pale), 1e-3F)));
}

}  // namespace

EyeColours SampleEyes(const FoundFace& face, const PhotoIrises& irises, const fsm::Image& photo) {
  const PhotoLookNumbers& look = PhotoLook();
  std::vector<glm::vec3> iris, white;
  for (const fsm::Side side : fsm::kSides) {
    const EyePoints outline = EyePointsOf(side, face);
    const glm::vec2 a = outline[kOuterCorner], b = outline[kInnerCorner];
    const float width = glm::distance(a, b);
    const IrisCircle& circle = irises.eyes[side].circle;
    for (float y = -kHalfHeight; y <= kHalfHeight; y += kSampleStep) {
      for (float x = -kHalfWidth; x <= kHalfWidth; x += kSampleStep) {
        const glm::vec2 pixel = 0.5F * (a + b) + width * glm::vec2(x, y);
        if (SignedDistance(outline, pixel) > -kFromLids * width) continue;
        const float radii = glm::distance(pixel, circle.centre_px) / circle.radius_px;
        const glm::vec3 colour = ColourAt(photo, pixel);
        if (look.iris.sampled_radii.Contains(radii)) iris.push_back(colour);
        if (radii > look.white.sampled_from_radii) white.push_back(colour);
      }
    }
  }
  return {.iris = DrawnIris(Typical(iris, look.iris.rank_share, look.iris.unseen_colour)),
          .white = DrawnWhite(Typical(white, look.white.rank_share, look.white.unseen_colour),
                              SkinLight(face, photo))};
}

MouthColours SampleMouth(const FoundFace& face, const fsm::Image& photo) {
  const PhotoLookNumbers& look = PhotoLook();
  // Sampled along the middle of the lower lip, where it is thickest.
  constexpr std::size_t kFirst = 2, kLast = 6;
  glm::vec3 lip(0);
  for (std::size_t k = kFirst; k <= kLast; ++k) {
    const glm::vec2 pixel =
        0.5F * (face.PixelOf(point::kLowerOuterLip[k]) + face.PixelOf(point::kLowerInnerLip[k]));
    lip += fsm::SrgbToLinear(ColourAt(photo, pixel) / 255.0F) / float{kLast - kFirst + 1};
  }
  // The inner rim is in shade.
  const auto& inner = look.lips.inner;
  const auto& teeth = look.teeth;
  return {.lip = inner.brightness * glm::pow(lip, glm::vec3(inner.power)),
          .teeth = std::min(teeth.unlit_brightness + teeth.per_skin_light * SkinLight(face, photo),
                            teeth.most_brightness)};
}

}  // namespace facefit
