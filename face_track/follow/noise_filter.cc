#include "face_track/follow/noise_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <utility>
#include <vector>

#include "face_fit/find/network/face_networks.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"

namespace facetrack {
namespace {

constexpr int kTile = 8;  // pixels on a side of what noise is measured in
// The part of the tiles that change least: what changes there is noise, even where a face moves.
constexpr float kStill = 0.3F;
// What changes by more than so many times the noise that a picture shows by itself is motion.
constexpr float kMotion = 8;
constexpr float kGain = 0.2F;  // of a new measurement of the noise

constexpr int kBlock = 16, kSearch = 6;  // pixels: what is followed, and how far
// In deviations of the noise: a block that moves fits better by that.
constexpr float kStay = 0.15F;

// With 15 one of two heads was found better, but of what moves more was left behind.
constexpr float kMostPictures = 7;
// How much more than noise a place with 2 pixels around it may change from picture to picture, by
// its mean square and by its mean colour: up to the first it counts as the same, from the second on
// as something else.
constexpr int kAround = 2;
constexpr float kSameSquare = 1.3F, kOtherSquare = 2, kSameMean = 6, kOtherMean = 16;

using Grey = facefit::Raster<std::uint8_t>;

/// A part of a picture; outside, the edge is repeated.
Grey GreyOf(const fsm::Image& image, int left, int top, int width, int height) {
  return Grey::From(width, height, [&](int x, int y) {
    const std::uint8_t* p = &image.rgba[4 * image.Index(std::clamp(left + x, 0, image.width - 1),
                                                        std::clamp(top + y, 0, image.height - 1))];
    return static_cast<std::uint8_t>((p[0] + 2 * p[1] + p[2]) / 4);
  });
}

/// The variance of the noise in a tile by its second differences (Immerkaer, Fast Noise Variance
/// Estimation, 1996).
float VarianceOf(const Grey& grey, int left, int top) {
  int squares = 0;
  for (int y = top; y < top + kTile; ++y) {
    for (int x = left; x < left + kTile; ++x) {
      const std::uint8_t *above = &grey.values[grey.Index(x, y - 1)],
                         *here = &grey.values[grey.Index(x, y)],
                         *below = &grey.values[grey.Index(x, y + 1)];
      const auto across = [](const std::uint8_t* p) { return p[-1] - 2 * p[0] + p[1]; };
      const int second = across(above) - 2 * across(here) + across(below);
      squares += second * second;
    }
  }
  return static_cast<float>(squares) / (36 * kTile * kTile);
}

/// How much one block differs from another, by the sum of absolute differences.
int Difference(const Grey& a, int ax, int ay, const Grey& b, int bx, int by) {
  int sum = 0;
  for (int y = 0; y < kBlock; ++y) {
    const std::uint8_t* p = &a.values[a.Index(ax, ay + y)];
    const std::uint8_t* q = &b.values[b.Index(bx, by + y)];
    for (int x = 0; x < kBlock; ++x) sum += std::abs(p[x] - q[x]);
  }
  return sum;
}

/// Where the block of `now` lies in `then`, which begins kSearch pixels before it on both axes.
glm::ivec2 MotionOf(const Grey& now, const Grey& then, int x, int y, float noise) {
  const int stay = static_cast<int>(kStay * noise * kBlock * kBlock);
  int least = Difference(now, x, y, then, x + kSearch, y + kSearch) - stay;
  glm::ivec2 motion(0);
  for (int dy = -kSearch; dy <= kSearch; ++dy) {
    for (int dx = -kSearch; dx <= kSearch; ++dx) {
      const int off = Difference(now, x, y, then, x + kSearch + dx, y + kSearch + dy);
      if (off < least) least = off, motion = {dx, dy};
    }
  }
  return motion;
}

/// 1 up to `same`, 0 from `other` on.
float Falling(float value, float same, float other) {
  return std::clamp((other - value) / (other - same), 0.0F, 1.0F);
}

}  // namespace

void NoiseFilter::Forget() { before_ = mean_ = {}; }

const fsm::Image& NoiseFilter::Filter(const fsm::Image& picture, const facefit::NetworkCrop& crop) {
  const float reach =
      0.55F * crop.size * (std::abs(std::cos(crop.angle_rad)) + std::abs(std::sin(crop.angle_rad)));
  const auto edge = [](float v, int most) {
    return static_cast<int>(std::clamp(v, 0.0F, static_cast<float>(most)));
  };
  const int left = edge(crop.centre.x - reach, picture.width),
            top = edge(crop.centre.y - reach, picture.height);
  const Area area{left, top, edge(crop.centre.x + reach, picture.width) - left,
                  edge(crop.centre.y + reach, picture.height) - top};
  shrunk_ = std::max(crop.size / facefit::kLandmarkInputPixels, 1.0F);
  const bool follows = before_.width == picture.width && before_.height == picture.height &&
                       area.width >= kTile && area.height >= kTile;
  if (follows) Measure(picture, area);
  const bool filters = follows && IsNoisy();
  if (filters) {
    Average(picture, area);
  } else {
    mean_ = {};
  }
  before_ = picture;
  return filters ? mean_ : picture;
}

void NoiseFilter::Measure(const fsm::Image& picture, const Area& area) {
  const Grey grey = GreyOf(picture, area.left - 1, area.top - 1, area.width + 2, area.height + 2);
  std::vector<float> variances;
  for (int top = area.top; top + kTile <= area.top + area.height; top += kTile) {
    for (int left = area.left; left + kTile <= area.left + area.width; left += kTile) {
      std::array<int, 4> sums{};
      int squares = 0;
      for (int y = top; y < top + kTile; ++y) {
        const std::uint8_t* now = &picture.rgba[4 * picture.Index(left, y)];
        const std::uint8_t* then = &before_.rgba[4 * before_.Index(left, y)];
        for (std::size_t i = 0; i < 4 * kTile; ++i) {
          const int by = now[i] - then[i];  // of alpha 0
          sums[i % 4] += by;
          squares += by * by;
        }
      }
      constexpr float kPixels = kTile * kTile;
      auto variance = static_cast<float>(squares);
      for (const int sum : sums) variance -= static_cast<float>(sum * sum) / kPixels;
      variance /= 3 * kPixels * 2;  // both pictures are noisy
      variances.push_back(
          std::min(variance, kMotion * VarianceOf(grey, left - area.left + 1, top - area.top + 1)));
    }
  }
  const auto still = variances.begin() +
                     static_cast<std::ptrdiff_t>(kStill * static_cast<float>(variances.size()));
  std::ranges::nth_element(variances, still);
  const float noise = std::sqrt(*still);
  noise_ = noise_ ? *noise_ + kGain * (noise - *noise_) : noise;
}

void NoiseFilter::Average(const fsm::Image& picture, const Area& area) {
  if (mean_.rgba.empty()) {
    mean_ = before_;
    pictures_ = facefit::FloatImage(picture.width, picture.height, 1);
  }
  const fsm::Image mean = std::exchange(mean_, picture);
  const auto pictures =
      std::exchange(pictures_, facefit::FloatImage(picture.width, picture.height, 1));
  const float variance = *noise_ * *noise_;
  facefit::VectorImage past(area.width, area.height), by(area.width, area.height);
  facefit::FloatImage count(area.width, area.height), square(area.width, area.height);
  const Grey now = GreyOf(picture, area.left, area.top, area.width + kBlock, area.height + kBlock);
  const Grey then = GreyOf(mean, area.left - kSearch, area.top - kSearch,
                           area.width + kBlock + 2 * kSearch, area.height + kBlock + 2 * kSearch);
  for (int top = 0; top < area.height; top += kBlock) {
    for (int left = 0; left < area.width; left += kBlock) {
      const glm::ivec2 motion = MotionOf(now, then, left, top, *noise_);
      for (int y = top; y < std::min(top + kBlock, area.height); ++y) {
        for (int x = left; x < std::min(left + kBlock, area.width); ++x) {
          const std::size_t from =
              mean.Index(std::clamp(area.left + x + motion.x, 0, mean.width - 1),
                         std::clamp(area.top + y + motion.y, 0, mean.height - 1));
          const std::size_t i = count.Index(x, y);
          past[i] = facefit::Rgb(mean, from);
          by[i] = facefit::Rgb(picture, picture.Index(area.left + x, area.top + y)) - past[i];
          count[i] = pictures[from];
          square[i] = glm::dot(by[i], by[i]) / (3 * variance * (1 + 1 / count[i]));
        }
      }
    }
  }
  square = facefit::Blurred(square, kAround);
  const auto mean_by = facefit::Blurred(by, kAround);
  constexpr float kPixels = (2 * kAround + 1) * (2 * kAround + 1);
  facefit::ForEachPixel(area.width, area.height, [&](int x, int y, std::size_t i) {
    const glm::vec3 squared = mean_by[i] * mean_by[i];
    const float colour =
        std::max({squared.r, squared.g, squared.b}) * kPixels / (variance * (1 + 1 / count[i]));
    const float kept = std::min(count[i], kMostPictures) *
                       Falling(square[i], kSameSquare, kOtherSquare) *
                       Falling(colour, kSameMean, kOtherMean);
    const std::size_t to = mean_.Index(area.left + x, area.top + y);
    pictures_[to] = kept + 1;
    facefit::SetRgb(mean_, to, past[i] + by[i] / (kept + 1));
  });
}

}  // namespace facetrack
