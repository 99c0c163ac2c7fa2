#include "face_fit/bake/skin_colours.h"

#include <algorithm>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/image/filters.h"
#include "face_fit/image/median.h"
#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

constexpr float kWellCovered = 0.9F;  // coverage from which a texel shows the photo's own colour
// Lengths on the face. Edges of hair fade over kHairEdgeMm. Lines of the forehead are narrower than
// kFringeMm, a fringe is wider. Wrinkles are wider than kFineMm and closer than kWideMm.
constexpr float kHairEdgeMm = 1.5F, kFringeMm = 2.5F, kFineMm = 0.5F, kWideMm = 2.5F;

}  // namespace

float Saturation(const fsm::Image& map, const Mask& coverage) {
  float sum = 0, light = 0;
  for (std::size_t i = 0; i < coverage.size(); ++i) {
    if (coverage[i] < kWellCovered) continue;
    const glm::vec3 c = Rgb(map, i);
    const float brightest = std::max({c.r, c.g, c.b});
    sum += brightest - std::min({c.r, c.g, c.b});
    light += brightest;
  }
  return PhotoLook().colour.difference.Ramp(sum / std::max(light, 1.0F));
}

glm::vec3 LightGain(glm::vec3 to, glm::vec3 from) {
  return PhotoLook().light_gain.Clamp(to / from);
}

Mask SkinLikeness(const fsm::Image& map, const Mask& face_coverage) {
  std::vector<glm::vec3> colours;
  for (std::size_t i = 0; i < face_coverage.size(); ++i) {
    if (face_coverage[i] >= kWellCovered) colours.push_back(Rgb(map, i));
  }
  Mask likeness(map.width, map.height, 1);
  if (colours.empty()) return likeness;
  const fsm::Range hair = PhotoLook().hair_detection.darker_log;
  constexpr float kDark = 8;  // of 255; differences in the dark that do not count
  const glm::vec3 middle = Median(colours) + kDark;
  for (std::size_t i = 0; i < likeness.size(); ++i) {
    const glm::vec3 darker = glm::log(middle / (Rgb(map, i) + kDark));
    likeness[i] = hair.Ramp(std::max({darker.r, darker.g, darker.b, 0.0F}));
  }
  return Blurred(likeness, MmToTexels(kHairEdgeMm, map.width));
}

float Roughness(const fsm::Image& map, const Mask& face_coverage) {
  // Weights as of human vision, which sees wrinkles; Brightness is for faces.
  constexpr glm::vec3 kVision(0.3F, 0.6F, 0.1F);
  FloatImage light(map.width, map.height);
  for (std::size_t i = 0; i < light.size(); ++i) {
    light[i] = glm::dot(Rgb(map, i), kVision);
  }
  const FloatImage fine = Blurred(light, MmToTexels(kFineMm, map.width)),
                   wide = Blurred(light, MmToTexels(kWideMm, map.width));
  std::vector<float> steps;
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (face_coverage[i] < kWellCovered) continue;
    steps.push_back(std::abs(fine[i] - wide[i]) / std::max(wide[i], 8.0F));
  }
  return steps.empty() ? 0 : Median(std::move(steps));
}

Mask CutAtHairline(const SkinTexels& texels, float brows_y_mm, Mask likeness) {
  const Mask wide = Blurred(likeness, MmToTexels(kFringeMm, likeness.width));
  const fsm::Range edge = PhotoLook().hair_detection.skin_around_share;
  Mask below_hairline(likeness.width, likeness.height, 1);
  for (int x = 0; x < likeness.width; ++x) {
    float least = 1;
    for (int y = likeness.height - 1; y >= 0; --y) {
      if (const auto& texel = texels(x, y); texel && texel->y_mm > brows_y_mm)
        least = std::min(least, edge.Ramp(wide(x, y)));
      below_hairline(x, y) = least;
    }
  }
  below_hairline = Blurred(below_hairline, MmToTexels(kHairEdgeMm, likeness.width));
  for (std::size_t i = 0; i < likeness.size(); ++i) {
    likeness[i] = std::min(likeness[i], below_hairline[i]);
  }
  return likeness;
}

}  // namespace facefit
