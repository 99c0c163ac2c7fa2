#include "fsm/head/photo_lids.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>

#include "fsm/head/spline.h"

namespace fsm {
namespace {

struct Sample {
  float x;  ///< along the eye, millimetres
  glm::vec3 screen;
};

float Brightness(glm::vec3 c) { return 0.3f * c.r + 0.6f * c.g + 0.1f * c.b + 0.004f; }

glm::vec3 PixelAt(const WornPhoto& photo, glm::vec3 place) {
  const auto at = [](float part, int size) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(part * static_cast<float>(size)), 0, size - 1));
  };
  const std::uint8_t* p =
      &photo.rgba[4 * (at(place.y, photo.height) * static_cast<std::size_t>(photo.width) +
                       at(place.x, photo.width))];
  return glm::vec3(p[0], p[1], p[2]) / 255.0f;
}

glm::vec3 Median(std::vector<Sample>& samples) {
  const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
  std::ranges::nth_element(samples, middle, {},
                           [](const Sample& s) { return Brightness(s.screen); });
  return middle->screen;
}

/// The mean of samples near `x`, those of usual brightness above all.
glm::vec3 Near(std::span<const Sample> samples, float x, float usual, glm::vec3 otherwise) {
  constexpr float kReach = 6;      // millimetres
  constexpr float kSpread = 1.0f;  // of the logarithm of brightness
  glm::vec3 sum = 0.001f * otherwise;
  float weight = 0.001f;
  for (const Sample& s : samples) {
    const float off = (s.x - x) / kReach;
    const float odd = std::log(Brightness(s.screen) / usual) / kSpread;
    const float w = std::exp(-off * off - odd * odd);
    sum += w * s.screen;
    weight += w;
  }
  return sum / weight;
}

}  // namespace

std::vector<LidPaint> PaintLids(const WornPhoto& photo, std::span<const glm::vec3> places,
                                std::span<const Flesh> skin) {
  std::vector<LidPaint> lids;
  for (const int side : {-1, 1}) {
    // How far a place goes with a lid: 1 at the rim, a third where the lid ends, 0 at the socket's.
    std::vector<Sample> above, below;
    for (std::size_t i = 0; i < skin.size(); ++i) {
      const Flesh& f = skin[i];
      if (f.eye != side) continue;
      const Sample sample{f.domain.x, PixelAt(photo, places[i])};
      if (f.lid_upper > 0.01f && f.lid_upper < 0.25f) above.push_back(sample);
      if (f.lid_lower > 0.10f && f.lid_lower < 0.7f) below.push_back(sample);
    }
    std::vector<Sample> all = above;
    all.insert(all.end(), below.begin(), below.end());
    if (above.empty() || below.empty()) continue;
    const glm::vec3 usual = Median(all);
    // Sockets may well be darker than what lies round them.
    const glm::vec3 usual_above = glm::sqrt(usual * Median(above));
    for (std::uint32_t i = 0; i < skin.size(); ++i) {
      const Flesh& f = skin[i];
      const float part = SmoothStep(0.06f, 0.55f, f.lid_upper);
      if (f.eye != side || part <= 0) continue;
      const float down = SmoothStep(0.1f, 0.95f, f.lid_upper);
      const glm::vec3 colour =
          glm::mix(Near(above, f.domain.x, Brightness(usual_above), usual_above),
                   Near(below, f.domain.x, Brightness(usual), usual), 0.05f + 0.35f * down);
      // The ball rounds the lid; the fold over it is in shade, and so are the lashes' roots.
      const float round = 0.94f + 0.06f * SmoothStep(0.5f, 0.85f, f.lid_upper) -
                          0.10f * SmoothStep(0.55f, 0.3f, f.lid_upper);
      const float lashes = 1 - 0.7f * SmoothStep(0.95f, 1.0f, f.lid_upper);
      // A part of the photo stays, which has the skin's grain.
      lids.push_back({i, glm::clamp(colour * (round * lashes), 0.0f, 1.0f), 0.78f * part});
    }
  }
  return lids;
}

}  // namespace fsm
