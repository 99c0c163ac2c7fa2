#include "face_fit/dress/skin_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

namespace facefit {
namespace {

constexpr float kSeen = 0.9F;

}  // namespace

float Saturation(const fsm::Image& map, const FloatImage& seen) {
  float sum = 0, light = 0;
  for (std::size_t i = 0; i < seen.at.size(); ++i) {
    if (seen.at[i] < kSeen) continue;
    const std::uint8_t* p = &map.rgba[4 * i];
    sum += static_cast<float>(std::max({p[0], p[1], p[2]}) - std::min({p[0], p[1], p[2]}));
    light += static_cast<float>(std::max({p[0], p[1], p[2]}));
  }
  return glm::smoothstep(0.04F, 0.16F, sum / std::max(light, 1.0F));
}

FloatImage SkinLikeness(const fsm::Image& map, const FloatImage& face_seen) {
  std::array<std::vector<std::uint8_t>, 3> channels;
  for (std::size_t i = 0; i < face_seen.at.size(); ++i) {
    if (face_seen.at[i] < kSeen) continue;
    for (std::size_t c = 0; c < 3; ++c) channels[c].push_back(map.rgba[4 * i + c]);
  }
  FloatImage likeness(map.width, map.height, 1);
  if (channels[0].empty()) return likeness;
  std::array<float, 3> middle{};
  constexpr float kDark = 8;  // steps of brightness that make no difference
  for (std::size_t c = 0; c < 3; ++c) {
    const auto half = channels[c].begin() + static_cast<std::ptrdiff_t>(channels[c].size() / 2);
    std::ranges::nth_element(channels[c], half);
    middle[c] = static_cast<float>(*half) + kDark;
  }
  for (std::size_t i = 0; i < likeness.at.size(); ++i) {
    float darker = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      darker =
          std::max(darker, std::log(middle[c] / (static_cast<float>(map.rgba[4 * i + c]) + kDark)));
    }
    likeness.at[i] = glm::smoothstep(0.6F, 0.3F, darker);
  }
  return Blurred(likeness, map.width / 170);
}

float Roughness(const fsm::Image& map, const FloatImage& face_seen) {
  FloatImage light(map.width, map.height);
  for (std::size_t i = 0; i < light.at.size(); ++i) {
    const std::uint8_t* p = &map.rgba[4 * i];
    light.at[i] = 0.3F * static_cast<float>(p[0]) + 0.6F * static_cast<float>(p[1]) +
                  0.1F * static_cast<float>(p[2]);
  }
  // The face is some 400 texels wide at a side of 1024: lines are 1 to 4 mm apart.
  const FloatImage fine = Blurred(light, map.width / 512), wide = Blurred(light, map.width / 100);
  std::vector<float> steps;
  for (std::size_t i = 0; i < light.at.size(); ++i) {
    if (face_seen.at[i] < kSeen) continue;
    steps.push_back(std::abs(fine.at[i] - wide.at[i]) / std::max(wide.at[i], 8.0F));
  }
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle;
}

void EndAtHair(const std::vector<float>& up, FloatImage& likeness) {
  // A line of the forehead is narrower than this, a fringe is not.
  const FloatImage wide = Blurred(likeness, likeness.width / 100);
  FloatImage skin(likeness.width, likeness.height, 1);
  for (int x = 0; x < likeness.width; ++x) {
    float least = 1;
    for (int y = likeness.height - 1; y >= 0; --y) {
      const auto i = static_cast<std::size_t>(y * likeness.width + x);
      if (up[i] > 0) least = std::min(least, glm::smoothstep(0.35F, 0.75F, wide.at[i]));
      skin.at[i] = least;
    }
  }
  skin = Blurred(skin, likeness.width / 170);
  for (std::size_t i = 0; i < likeness.at.size(); ++i) {
    likeness.at[i] = std::min(likeness.at[i], skin.at[i]);
  }
}

}  // namespace facefit
