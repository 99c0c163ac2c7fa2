#include "fsm/head/skin_membrane.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "fsm/head/face_light.h"

namespace fsm {
namespace {

constexpr float kStep = 0.75f;  // size of the membrane's cells, millimetres

/// Returns the quantile `share` of the brightness of the samples that `which` accepts; 0.5 if it
/// accepts none.
template <typename Which>
float UsualBrightness(std::span<const SkinSample> samples, float share, Which which) {
  std::vector<float> all;
  for (const SkinSample& s : samples) {
    if (which(s)) all.push_back(ScreenBrightness(s.screen));
  }
  if (all.empty()) return 0.5f;
  const auto place =
      all.begin() + static_cast<std::ptrdiff_t>(share * static_cast<float>(all.size() - 1));
  std::ranges::nth_element(all, place);
  return *place;
}

}  // namespace

void DownweightOutliers(std::span<SkinSample> samples, float usual_above) {
  // Spreads of the logarithm of brightness. Above the eye there are lashes and the brow's shade.
  constexpr float kSpreadAbove = 0.3f, kSpreadBelow = 0.6f;
  constexpr float kDarkest = 3;  // a socket, unlike lashes, is at most this many times darker
  constexpr float kOwn = 0.85f;  // weight of the brightness of the sample's own side
  const float usual =
      UsualBrightness(samples, 0.5f, [](const SkinSample& s) { return s.confidence > 0; });
  const auto mostly = [&](bool above) {
    const float here =
        UsualBrightness(samples, above ? usual_above : 0.5f, [above](const SkinSample& s) {
          return s.confidence > 0 && s.beside_lid && s.above == above;
        });
    return std::pow(usual, 1 - kOwn) * std::pow(std::max(here, usual / kDarkest), kOwn);
  };
  const float above = mostly(true), below = mostly(false);
  for (SkinSample& s : samples) {
    const float odd = std::log(ScreenBrightness(s.screen) / (s.above ? above : below)) /
                      (s.above ? kSpreadAbove : kSpreadBelow);
    s.confidence *= std::exp(-odd * odd);
  }
}

glm::vec3 MeanBelow(std::span<const SkinSample> samples) {
  glm::vec3 sum(1e-4f);
  float weight = 1e-4f;
  for (const SkinSample& s : samples) {
    if (s.above) continue;
    sum += s.confidence * s.screen;
    weight += s.confidence;
  }
  return sum / weight;
}

SkinMembrane::SkinMembrane(std::span<const SkinSample> samples) {
  constexpr float kMax = 150;      // cells in each direction
  constexpr float kStiff = 0.15f;  // stiffness relative to what is known at a cell
  constexpr int kRounds = 300;
  glm::vec2 low(1e9f), high(-1e9f);
  for (const SkinSample& s : samples) {
    low = glm::min(low, s.position);
    high = glm::max(high, s.position);
  }
  low_ = low - kStep;
  width_ = static_cast<int>(std::min((high.x - low_.x) / kStep, kMax)) + 2;
  height_ = static_cast<int>(std::min((high.y - low_.y) / kStep, kMax)) + 2;
  std::vector<glm::vec4> held(static_cast<std::size_t>(width_ * height_), glm::vec4(0));
  glm::vec4 all(0);
  for (const SkinSample& s : samples) {
    const glm::ivec2 c(glm::round((s.position - low_) / kStep));
    const glm::vec4 sample(s.confidence * s.screen, s.confidence);
    held[Cell(c.x, c.y)] += sample;
    all += sample;
  }
  colour_.assign(held.size(), glm::vec3(all) / std::max(all.w, 1e-6f));
  for (int round = 0; round < kRounds; ++round) {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const glm::vec3 beside = colour_[Cell(x - 1, y)] + colour_[Cell(x + 1, y)] +
                                 colour_[Cell(x, y - 1)] + colour_[Cell(x, y + 1)];
        const glm::vec4 here = held[Cell(x, y)];
        colour_[Cell(x, y)] = (glm::vec3(here) + kStiff * beside) / (here.w + 4 * kStiff);
      }
    }
  }
}

glm::vec3 SkinMembrane::At(glm::vec2 at) const {
  const glm::vec2 p = (at - low_) / kStep;
  const glm::vec2 corner = glm::floor(p), within = p - corner;
  const auto row = [&](float y) {
    const int x = static_cast<int>(corner.x);
    return glm::mix(colour_[Cell(x, static_cast<int>(y))],
                    colour_[Cell(x + 1, static_cast<int>(y))], within.x);
  };
  return glm::mix(row(corner.y), row(corner.y + 1), within.y);
}

std::size_t SkinMembrane::Cell(int x, int y) const {
  return static_cast<std::size_t>(std::clamp(y, 0, height_ - 1) * width_ +
                                  std::clamp(x, 0, width_ - 1));
}

}  // namespace fsm
