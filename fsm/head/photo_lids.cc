#include "fsm/head/photo_lids.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

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

/// Skin below an eye that lends its grain to the lid above it.
struct Lender {
  glm::vec2 at, place;
  glm::vec3 screen;
};

/// Means with weights that fall off with the distance from `at`, millimetres.
Lender Around(std::span<const Lender> lenders, glm::vec2 at, float reach) {
  Lender mean{at, glm::vec2(0), glm::vec3(0)};
  float weight = 1e-9f;
  for (const Lender& l : lenders) {
    const glm::vec2 off = (l.at - at) / reach;
    const float w = std::exp(-glm::dot(off, off)) + 1e-8f;
    mean.place += w * l.place;
    mean.screen += w * l.screen;
    weight += w;
  }
  mean.place /= weight;
  mean.screen /= weight;
  return mean;
}

/// Of a line of places by x; 0 without any.
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

/// How places in the photo go with places on the face: the slope of the plane through them.
glm::mat2 PhotoByFace(std::span<const Lender> all) {
  Lender mean{glm::vec2(0), glm::vec2(0), glm::vec3(0)};
  for (const Lender& l : all) {
    mean.at += l.at / static_cast<float>(all.size());
    mean.place += l.place / static_cast<float>(all.size());
  }
  glm::mat2 spread(1e-6f), both(0);
  for (const Lender& l : all) {
    spread += glm::outerProduct(l.at - mean.at, l.at - mean.at);
    both += glm::outerProduct(l.place - mean.place, l.at - mean.at);
  }
  return both * glm::inverse(spread);
}

}  // namespace

std::vector<LidPaint> PaintLids(const WornPhoto& photo, std::span<const glm::vec3> places,
                                std::span<const Flesh> skin, std::span<const glm::vec3> open,
                                std::span<const glm::vec3> shut) {
  std::vector<LidPaint> lids;
  for (const int side : {-1, 1}) {
    // How far a place goes with a lid: 1 at the rim, a third where the lid ends, 0 at the socket's.
    std::vector<Sample> above, below;
    std::vector<Lender> lenders;
    std::vector<glm::vec2> upper_rim, lower_rim;
    for (std::size_t i = 0; i < skin.size(); ++i) {
      const Flesh& f = skin[i];
      if (f.eye != side) continue;
      const glm::vec2 at(open[i]);
      const Sample sample{at.x, PixelAt(photo, places[i])};
      if (f.lid_upper > 0.01f && f.lid_upper < 0.25f) above.push_back(sample);
      if (f.lid_lower > 0.10f && f.lid_lower < 0.7f) below.push_back(sample);
      if (f.lid_upper > 0.95f) upper_rim.push_back(at);
      if (f.lid_lower > 0.95f) lower_rim.push_back(at);
      lenders.push_back({at, glm::vec2(places[i]), sample.screen});
    }
    if (above.empty() || below.empty() || upper_rim.empty() || lower_rim.empty()) continue;
    const auto [rim_first, rim_last] = std::ranges::minmax(upper_rim, {}, &glm::vec2::x);
    const float rim_from = rim_first.x, rim_to = rim_last.x;
    const glm::mat2 photo_by_face = PhotoByFace(lenders);
    std::erase_if(lenders,
                  [&](const Lender& l) { return l.at.y > HeightAt(lower_rim, l.at.x) - 0.5f; });
    std::vector<Sample> all = above;
    all.insert(all.end(), below.begin(), below.end());
    const glm::vec3 usual = Median(all);
    // Sockets may well be darker than what lies round them.
    const glm::vec3 usual_above = glm::sqrt(usual * Median(above));
    for (std::uint32_t i = 0; i < skin.size(); ++i) {
      const Flesh& f = skin[i];
      if (f.eye != side || f.lid_upper <= 0) continue;
      const glm::vec2 at(shut[i]);
      const float meet = HeightAt(lower_rim, at.x), rim = HeightAt(upper_rim, at.x);
      const float down = SmoothStep(rim, meet, at.y);
      const glm::vec3 over = Near(above, at.x, Brightness(usual_above), usual_above);
      const glm::vec3 under = Near(below, at.x, Brightness(usual), usual);
      // As light as the skin on either side of it; half of the hue of most of it,
      // because near an eye there are lashes and blue shade.
      const float light = Brightness(glm::mix(over, under, 0.2f + 0.3f * down));
      const glm::vec3 hue = usual / Brightness(usual) + under / Brightness(under);
      const glm::vec3 colour = 0.5f * light * hue;
      // The ball rounds the lid, most in the middle; the fold over it is in shade, and so are the
      // lashes' roots.
      const float aside = (2 * at.x - rim_from - rim_to) / std::max(rim_to - rim_from, 1.0f);
      const float bulge = SmoothStep(0.0f, 0.35f, down) * SmoothStep(1.0f, 0.6f, down);
      const float round = 0.90f + 0.10f * bulge - 0.14f * std::min(aside * aside, 1.2f);
      // Lashes are densest and longest outward.
      const float outward = SmoothStep(-0.3f, 0.9f, aside * static_cast<float>(side));
      const float lashes =
          1 - (0.5f + 0.2f * outward) * SmoothStep(0.975f - 0.025f * outward, 1.0f, f.lid_upper);
      const float part =
          SmoothStep(rim + 3.6f, rim + 0.4f, at.y) * SmoothStep(0.06f, 0.4f, f.lid_upper);
      const glm::vec2 mirrored(at.x, meet - 1.5f - std::max(at.y - meet, 0.0f));
      const Lender near = Around(lenders, mirrored, 1.5f), wide = Around(lenders, mirrored, 4);
      lids.push_back({i, glm::clamp(colour * (round * lashes), 0.0f, 1.0f), 0.92f * part,
                      near.place, Brightness(wide.screen),
                      photo_by_face * (at - glm::vec2(open[i]))});
    }
  }
  return lids;
}

}  // namespace fsm
