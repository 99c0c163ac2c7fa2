#include "face_fit/find/face/photo_lip_seam.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <ranges>

#include "face_fit/image/pixels.h"
#include "face_fit/image/plane.h"
#include "face_fit/image/resample.h"

namespace facefit {
namespace {

constexpr std::size_t kSteps = 41;  // along the mouth
constexpr std::size_t kInnerPoints = point::kUpperInnerLip.size();
constexpr int kOffsets = 25;  // offsets across the mouth that are tried at each step
/// Largest offset to either side, divided by the mouth's width.
constexpr float kLineReach = 0.08F;
/// Distance, divided by the mouth's width, of three samples whose mean is taken; hairs and chapped
/// spots are narrower.
constexpr float kLineBeside = 0.012F;

/// A value for each step along the mouth and each offset across it.
template <typename T>
using Strip = std::array<std::array<T, kOffsets>, kSteps>;

/// Returns where the network sees the lip seam: x is the position along the mouth, y the distance
/// below the line between its ends, pixels. `begin`: the right end; `along`, `down`: unit; `width`:
/// of the mouth, pixels.
std::array<glm::vec2, kInnerPoints + 2> NetworkLine(const FoundFace& face, glm::vec2 begin,
                                                    glm::vec2 along, glm::vec2 down, float width) {
  std::array<glm::vec2, kInnerPoints + 2> line{};
  for (const bool left : {false, true}) {
    const glm::vec2 corner = face.PixelOf(left ? point::kMouthLeft : point::kMouthRight) - begin;
    line[left ? kInnerPoints + 1 : 0] = {glm::dot(corner, along) / width, 0};
  }
  for (std::size_t k = 0; k < kInnerPoints; ++k) {
    const glm::vec2 upper = face.PixelOf(point::kUpperInnerLip[k]),
                    lower = face.PixelOf(point::kLowerInnerLip[k]);
    const glm::vec2 middle = 0.5F * (upper + lower) - begin;
    line[k + 1] = {glm::dot(middle, along) / width, glm::dot(middle, down)};
  }
  return line;
}

/// Returns the position along the mouth of a step, 0..1.
float PositionOf(std::size_t step) { return static_cast<float>(step) / (kSteps - 1); }

/// Returns how much of the network's line counts at a position along the mouth, 1 in the middle: it
/// errs most at the corners.
float Trust(float t) {
  constexpr float kAtCorners = 0.1F;
  const float off_middle = 2 * t - 1;
  return 1 - (1 - kAtCorners) * off_middle * off_middle;
}

/// The parabola nearest to a line.
class Parabola {
 public:
  explicit Parabola(std::span<const glm::vec2> line) {
    Eigen::Matrix3f normal = Eigen::Matrix3f::Zero();
    Eigen::Vector3f right_side = Eigen::Vector3f::Zero();
    for (const glm::vec2 p : line) {
      const Eigen::Vector3f powers = Powers(p.x);
      normal += Trust(p.x) * powers * powers.transpose();
      right_side += Trust(p.x) * p.y * powers;
    }
    coefficients_ = normal.ldlt().solve(right_side);
  }
  float At(float t) const { return coefficients_.dot(Powers(t)); }

 private:
  static Eigen::Vector3f Powers(float t) { return {1, t - 0.5F, (t - 0.5F) * (t - 0.5F)}; }
  Eigen::Vector3f coefficients_;
};

/// Returns the brightness of each pixel. `pixel_at(step, offset)`: its pixel; `beside`: from it to
/// the next sample along the mouth.
Strip<float> BrightnessOf(const fsm::Image& photo, glm::vec2 beside, auto pixel_at) {
  Strip<float> strip{};
  for (std::size_t i = 0; i < kSteps; ++i) {
    for (std::size_t o = 0; o < kOffsets; ++o) {
      const glm::vec2 pixel = pixel_at(i, static_cast<float>(o));
      for (const glm::vec2 p : {pixel, pixel - beside, pixel + beside}) {
        strip[i][o] += Brightness(ColourAt(photo, p)) / 3;
      }
    }
  }
  return strip;
}

/// Converts brightness to costs: 0 for the darkest pixel on the network's line, about 1 for the
/// brightest, and more the farther off that line a pixel is. Returns whether any is dark.
/// `network_offset(step)`: that of the network's line.
bool ToCosts(Strip<float>& strip, auto network_offset) {
  constexpr float kMinRange = 8, kStray = 0.25F;  // of 255; cost of the farthest offset
  const auto all = std::views::join(strip);
  const float least = std::ranges::min(all), range = std::ranges::max(all) - least;
  if (range < kMinRange) return false;
  for (std::size_t i = 0; i < kSteps; ++i) {
    for (std::size_t o = 0; o < kOffsets; ++o) {
      const float stray = (static_cast<float>(o) - network_offset(i)) / (kOffsets / 2);
      strip[i][o] = (strip[i][o] - least) / range + Trust(PositionOf(i)) * kStray * stray * stray;
    }
  }
  return true;
}

/// Returns for each step along the mouth the offset of the path with the least sum of costs, where
/// each change of it adds a cost that grows with its square (dynamic programming). `cost` is
/// overwritten.
std::array<int, kSteps> CheapestPath(Strip<float>& cost) {
  constexpr int kMaxStep = 3;
  constexpr float kBend = 0.03F;
  Strip<int> from{};
  for (std::size_t i = 1; i < kSteps; ++i) {
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
  std::array<int, kSteps> path{};
  auto at = static_cast<int>(std::ranges::min_element(cost.back()) - cost.back().begin());
  for (std::size_t i = kSteps; i-- > 0;) {
    path[i] = at;
    at = from[i][static_cast<std::size_t>(at)];
  }
  return path;
}

}  // namespace

glm::vec2 PhotoLipSeam::PixelAt(float along) const {
  const std::size_t last = pixels_.size() - 1;
  const float step = glm::clamp(along, 0.0F, 1.0F) * static_cast<float>(last);
  const auto k = std::min(static_cast<std::size_t>(step), last - 1);
  return glm::mix(pixels_[k], pixels_[k + 1], step - static_cast<float>(k));
}

PhotoLipSeam TraceLipSeam(const fsm::Image& photo, const FoundFace& face,
                          fsm::Sided<float> corners_along) {
  const glm::vec2 right = face.PixelOf(point::kMouthRight), left = face.PixelOf(point::kMouthLeft);
  const glm::vec2 axis = (left - right) / (corners_along.left - corners_along.right);
  const glm::vec2 begin = right - corners_along.right * axis;
  const float width = glm::length(axis);
  const glm::vec2 along = axis / width;
  const glm::vec2 down(-along.y, along.x);
  const auto network_line = NetworkLine(face, begin, along, down, width);
  const Parabola parabola(network_line);
  const float step = 2 * kLineReach * width / (kOffsets - 1);
  const auto pixel_at = [&](std::size_t i, float offset) {
    const float below = parabola.At(PositionOf(i)) + step * (offset - kOffsets / 2);
    return begin + PositionOf(i) * axis + below * down;
  };
  const auto network_offset = [&](std::size_t i) {
    const float t = PositionOf(i);
    return kOffsets / 2 + (LineYAt<glm::vec2>(network_line, t) - parabola.At(t)) / step;
  };
  // The path from end to end that is dark, smooth and near the network's line; that line where
  // nothing is dark.
  Strip<float> strip = BrightnessOf(photo, along * (kLineBeside * width), pixel_at);
  const bool dark = ToCosts(strip, network_offset);
  const auto path = CheapestPath(strip);
  std::vector<glm::vec2> pixels;
  for (std::size_t i = 0; i < kSteps; ++i) {
    pixels.push_back(pixel_at(i, dark ? static_cast<float>(path[i]) : network_offset(i)));
  }
  return PhotoLipSeam(std::move(pixels));
}

}  // namespace facefit
