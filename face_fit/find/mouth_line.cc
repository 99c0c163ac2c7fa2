#include "face_fit/find/mouth_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace facefit {
namespace {

/// Of the inner lips from the person's right to left, the upper one and what is under it.
constexpr std::array<std::pair<std::size_t, std::size_t>, 9> kInner = {{{191, 95},
                                                                        {80, 88},
                                                                        {81, 178},
                                                                        {82, 87},
                                                                        {13, 14},
                                                                        {312, 317},
                                                                        {311, 402},
                                                                        {310, 318},
                                                                        {415, 324}}};
constexpr int kOffsets = 25;  // looked at on the line across each place, half of them to each side
/// As far as it is looked, by the mouth's width: a tenth of 50 mm.
constexpr float kReach = 0.08F;

}  // namespace

bool LipsApart(const FoundFace& face) {
  const auto apart = [&face](std::size_t a, std::size_t b) {
    return glm::distance(glm::vec2(face.points[a]), glm::vec2(face.points[b]));
  };
  // Between the middles of the inner lips, by the width of the mouth.
  constexpr float kLeastGap = 0.06F;
  return apart(13, 14) > kLeastGap * apart(61, 291);
}

std::vector<glm::vec2> FindMouthLine(const fsm::Image& photo, const FoundFace& face, float first,
                                     float last) {
  const auto point = [&face](std::size_t i) { return glm::vec2(face.points[i]); };
  const glm::vec2 axis = (point(291) - point(61)) / (last - first);
  const glm::vec2 begin = point(61) - first * axis;
  const float width = glm::length(axis);
  const glm::vec2 along = axis / width;
  const glm::vec2 down(-along.y, along.x);
  // What the network says, as offsets below the straight line between the corners.
  std::array<std::pair<float, float>, kInner.size() + 2> said;
  said.front() = {0, 0};
  said.back() = {1, 0};
  for (std::size_t k = 0; k < kInner.size(); ++k) {
    const glm::vec2 middle = 0.5F * (point(kInner[k].first) + point(kInner[k].second)) - begin;
    said[k + 1] = {glm::dot(middle, along) / width, glm::dot(middle, down)};
  }
  const auto expected = [&](float t) {
    std::size_t k = 1;
    while (k + 1 < said.size() && said[k].first < t) ++k;
    const float span = std::max(said[k].first - said[k - 1].first, 1e-3F);
    const float part = glm::clamp((t - said[k - 1].first) / span, 0.0F, 1.0F);
    return glm::mix(said[k - 1].second, said[k].second, part);
  };
  // Of all ways from corner to corner the darkest that is smooth and near to what was said.
  const float step = 2 * kReach * width / (kOffsets - 1);
  std::array<std::array<float, kOffsets>, kMouthLinePlaces> dark{};
  std::array<float, kMouthLinePlaces> middle{};
  float least = 1e9F, most = 0;
  for (std::size_t i = 0; i < kMouthLinePlaces; ++i) {
    const float t = static_cast<float>(i) / (kMouthLinePlaces - 1);
    middle[i] = expected(t);
    for (int o = 0; o < kOffsets; ++o) {
      const float below = middle[i] + step * static_cast<float>(o - kOffsets / 2);
      const glm::vec2 at = begin + t * axis + below * down;
      const glm::vec2 beside = along * (0.012F * width);
      dark[i][static_cast<std::size_t>(o)] =
          (Brightness(ColourAt(photo, at)) + Brightness(ColourAt(photo, at - beside)) +
           Brightness(ColourAt(photo, at + beside))) /
          3;
      least = std::min(least, dark[i][static_cast<std::size_t>(o)]);
      most = std::max(most, dark[i][static_cast<std::size_t>(o)]);
    }
  }
  const float range = std::max(most - least, 8.0F);
  std::array<std::array<float, kOffsets>, kMouthLinePlaces> cost{};
  std::array<std::array<int, kOffsets>, kMouthLinePlaces> from{};
  for (std::size_t i = 0; i < kMouthLinePlaces; ++i) {
    for (int o = 0; o < kOffsets; ++o) {
      const auto k = static_cast<std::size_t>(o);
      const float off = static_cast<float>(o - kOffsets / 2) / (kOffsets / 2);
      float best = 0;
      if (i > 0) {
        best = std::numeric_limits<float>::max();
        for (int b = std::max(o - 3, 0); b <= std::min(o + 3, kOffsets - 1); ++b) {
          // A step of the line by itself costs nothing if what was said takes it too.
          const float bend = static_cast<float>(o - b);
          const float sum = cost[i - 1][static_cast<std::size_t>(b)] + 0.03F * bend * bend;
          if (sum < best) {
            best = sum;
            from[i][k] = b;
          }
        }
      }
      cost[i][k] = best + (dark[i][k] - least) / range + 0.25F * off * off;
    }
  }
  std::vector<glm::vec2> line(kMouthLinePlaces);
  auto at = static_cast<int>(std::ranges::min_element(cost.back()) - cost.back().begin());
  for (std::size_t i = kMouthLinePlaces; i-- > 0;) {
    const float t = static_cast<float>(i) / (kMouthLinePlaces - 1);
    const float below = middle[i] + step * static_cast<float>(at - kOffsets / 2);
    line[i] = begin + t * axis + below * down;
    at = from[i][static_cast<std::size_t>(at)];
  }
  return line;
}

}  // namespace facefit
