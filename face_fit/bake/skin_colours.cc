#include "face_fit/bake/skin_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {

constexpr float kSeen = 0.9F;

float Saturation(const fsm::Image& map, const FloatImage& seen) {
  float sum = 0, light = 0;
  for (std::size_t i = 0; i < seen.at.size(); ++i) {
    if (seen.at[i] < kSeen) continue;
    const glm::vec3 c = Rgb(map, i);
    const float brightest = std::max({c.r, c.g, c.b});
    sum += brightest - std::min({c.r, c.g, c.b});
    light += brightest;
  }
  return Ramp(PhotoLook().Pair("colour_difference"), sum / std::max(light, 1.0F));
}

FloatImage SkinLikeness(const fsm::Image& map, const FloatImage& face_seen) {
  std::array<std::vector<float>, 3> channels;
  for (std::size_t i = 0; i < face_seen.at.size(); ++i) {
    if (face_seen.at[i] < kSeen) continue;
    for (std::size_t c = 0; c < 3; ++c) channels[c].push_back(map.rgba[4 * i + c]);
  }
  FloatImage likeness(map.width, map.height, 1);
  if (channels[0].empty()) return likeness;
  std::array<float, 3> middle{};
  const glm::vec2 hair = PhotoLook().Pair("hair_darker");
  constexpr float kDark = 8;  // steps of brightness that make no difference
  for (std::size_t c = 0; c < 3; ++c) {
    middle[c] = Median(std::move(channels[c])) + kDark;
  }
  for (std::size_t i = 0; i < likeness.at.size(); ++i) {
    float darker = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      darker =
          std::max(darker, std::log(middle[c] / (static_cast<float>(map.rgba[4 * i + c]) + kDark)));
    }
    likeness.at[i] = Ramp(hair, darker);
  }
  return Blurred(likeness, map.width / 170);
}

float Roughness(const fsm::Image& map, const FloatImage& face_seen) {
  FloatImage light(map.width, map.height);
  for (std::size_t i = 0; i < light.at.size(); ++i) {
    light.at[i] = glm::dot(Rgb(map, i), glm::vec3(0.3F, 0.6F, 0.1F));
  }
  // The face is some 400 texels wide at a side of 1024: lines are 1 to 4 mm apart.
  const FloatImage fine = Blurred(light, map.width / 512), wide = Blurred(light, map.width / 100);
  std::vector<float> steps;
  for (std::size_t i = 0; i < light.at.size(); ++i) {
    if (face_seen.at[i] < kSeen) continue;
    steps.push_back(std::abs(fine.at[i] - wide.at[i]) / std::max(wide.at[i], 8.0F));
  }
  return steps.empty() ? 0 : Median(std::move(steps));
}

void CutAtHairline(const SkinTexels& texels, FloatImage& likeness) {
  // A line of the forehead is narrower than this, a fringe is not.
  const FloatImage wide = Blurred(likeness, likeness.width / 100);
  const glm::vec2 edge = PhotoLook().Pair("hair_edge");
  FloatImage skin(likeness.width, likeness.height, 1);
  for (int x = 0; x < likeness.width; ++x) {
    float least = 1;
    for (int y = likeness.height - 1; y >= 0; --y) {
      if (texels(x, y).above_brows_mm > 0) least = std::min(least, Ramp(edge, wide(x, y)));
      skin(x, y) = least;
    }
  }
  skin = Blurred(skin, likeness.width / 170);
  for (std::size_t i = 0; i < likeness.at.size(); ++i) {
    likeness.at[i] = std::min(likeness.at[i], skin.at[i]);
  }
}

}  // namespace facefit
