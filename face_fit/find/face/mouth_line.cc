#include "face_fit/find/face/mouth_line.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "face_fit/picture/pixels.h"
#include "face_fit/picture/plane.h"
#include "face_fit/picture/resample.h"

namespace facefit {
namespace {

constexpr std::size_t kInnerPoints = 9;  // points of an inner lip without its corners
constexpr int kOffsets = 25;             // offsets across the mouth that are tried at each step
/// Largest offset to either side, divided by the mouth's width.
constexpr float kLineReach = 0.08F;
/// Distance, divided by the mouth's width, of three samples whose mean is taken; hairs and chapped
/// spots are narrower.
constexpr float kLineBeside = 0.012F;

/// A value for each step along the mouth and each offset across it.
template <typename T>
using Strip = std::array<std::array<T, kOffsets>, kMouthLinePoints>;

/// Returns where the network sees the lips meet: x is the position along the mouth, y the distance
/// below the line between its ends, pixels. `begin`: the right end; `along`, `down`: unit; `width`:
/// of the mouth, pixels.
std::array<glm::vec2, kInnerPoints + 2> ExpectedLine(const FoundFace& face, glm::vec2 begin,
                                                     glm::vec2 along, glm::vec2 down, float width) {
  std::array<glm::vec2, kInnerPoints + 2> line{};
  line.back() = {1, 0};
  for (std::size_t k = 0; k < kInnerPoints; ++k) {
    const glm::vec2 upper = face.PixelOf(point::kUpperInnerLip[k + 1]),
                    lower = face.PixelOf(point::kLowerInnerLip[k]);
    const glm::vec2 middle = 0.5F * (upper + lower) - begin;
    line[k + 1] = {glm::dot(middle, along) / width, glm::dot(middle, down)};
  }
  return line;
}

/// Returns for each step along the mouth the offset of the path with the least sum of costs, where
/// each change of it adds a cost that grows with its square (dynamic programming). `cost` is
/// overwritten.
std::array<int, kMouthLinePoints> CheapestPath(Strip<float>& cost) {
  constexpr int kMaxStep = 3;
  constexpr float kBend = 0.03F;
  Strip<int> from{};
  for (std::size_t i = 1; i < kMouthLinePoints; ++i) {
    for (int o = 0; o < kOffsets; ++o) {
      const auto k = static_cast<std::size_t>(o);
      float best = std::numeric_limits<float>::max();
      for (int b = std::max(o - kMaxStep, 0); b <= std::min(o + kMaxStep, kOffsets - 1); ++b) {
        const float bend = static_cast<float>(o - b);
        const float sum = cost[i - 1][static_cast<std::size_t>(b)] + kBend * bend * bend;
        if (sum >= best) continue;
        best = sum;
        from[i][k] = b;
      }
      cost[i][k] += best;
    }
  }
  std::array<int, kMouthLinePoints> path{};
  auto at = static_cast<int>(std::ranges::min_element(cost.back()) - cost.back().begin());
  for (std::size_t i = kMouthLinePoints; i-- > 0;) {
    path[i] = at;
    at = from[i][static_cast<std::size_t>(at)];
  }
  return path;
}

}  // namespace

bool LipsApart(const FoundFace& face) {
  const auto apart = [&face](PointIndex a, PointIndex b) {
    return glm::distance(face.PixelOf(a), face.PixelOf(b));
  };
  // Distance of the middles of the inner lips, divided by the mouth's width.
  constexpr float kMinGap = 0.06F;
  return apart(point::kInnerLipTop, point::kInnerLipBottom) >
         kMinGap * apart(point::kMouthRight, point::kMouthLeft);
}

std::vector<glm::vec2> FindMouthLine(const fsm::Image& photo, const FoundFace& face, float first,
                                     float last) {
  const glm::vec2 right = face.PixelOf(point::kMouthRight), left = face.PixelOf(point::kMouthLeft);
  const glm::vec2 axis = (left - right) / (last - first);
  const glm::vec2 begin = right - first * axis;
  const float width = glm::length(axis);
  const glm::vec2 along = axis / width;
  const glm::vec2 down(-along.y, along.x);
  const auto expected = ExpectedLine(face, begin, along, down, width);
  const float step = 2 * kLineReach * width / (kOffsets - 1);
  const auto pixel_at = [&](std::size_t i, int offset) {
    const float t = static_cast<float>(i) / (kMouthLinePoints - 1);
    const float below = HeightAt(std::span<const glm::vec2>(expected), t) +
                        step * static_cast<float>(offset - kOffsets / 2);
    return begin + t * axis + below * down;
  };
  // Search the path from end to end that is dark, smooth and near the expected line.
  Strip<float> cost{};
  float least = 1e9F, most = 0;
  const glm::vec2 beside = along * (kLineBeside * width);
  for (std::size_t i = 0; i < kMouthLinePoints; ++i) {
    for (int o = 0; o < kOffsets; ++o) {
      const glm::vec2 pixel = pixel_at(i, o);
      float& dark = cost[i][static_cast<std::size_t>(o)];
      for (const glm::vec2 p : {pixel, pixel - beside, pixel + beside}) {
        dark += Brightness(ColourAt(photo, p)) / 3;
      }
      least = std::min(least, dark);
      most = std::max(most, dark);
    }
  }
  constexpr float kMinRange = 8, kStray = 0.25F;  // of 255; cost of the farthest offset
  const float range = std::max(most - least, kMinRange);
  for (auto& column : cost) {
    for (int o = 0; o < kOffsets; ++o) {
      float& value = column[static_cast<std::size_t>(o)];
      const float stray = static_cast<float>(o - kOffsets / 2) / (kOffsets / 2);
      value = (value - least) / range + kStray * stray * stray;
    }
  }
  const auto path = CheapestPath(cost);
  std::vector<glm::vec2> line;
  for (std::size_t i = 0; i < kMouthLinePoints; ++i) line.push_back(pixel_at(i, path[i]));
  return line;
}

}  // namespace facefit
