// Noise is taken off what stays and what moves, and nothing else is.

#include "face_track/follow/noise_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "face_fit/image/pixels.h"

namespace facetrack {
namespace {

constexpr int kSide = 200;
const facefit::NetworkCrop kCrop{.centre = {100, 100}, .size = 170};

/// A pattern that is `moved` pixels to the right, with a square that is dark or light.
fsm::Image Pattern(int moved, bool dark) {
  fsm::Image image = fsm::FilledImage(kSide, kSide);
  facefit::ForEachPixel(kSide, kSide, [&](int x, int y, std::size_t i) {
    const auto u = static_cast<float>(x - moved), v = static_cast<float>(y);
    float grey = 120 + 40 * std::sin(0.21F * u) * std::cos(0.17F * v);
    if (std::abs(x - 100) < 12 && std::abs(y - 100) < 6) grey = dark ? 60 : 170;
    facefit::SetRgb(image, i, glm::vec3(grey));
  });
  return image;
}

fsm::Image Noisy(fsm::Image image, float deviation, std::mt19937& chance) {
  std::normal_distribution<float> noise(0, deviation);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    if (i % 4 != 3)
      image.rgba[i] = facefit::Byte(static_cast<float>(image.rgba[i]) + noise(chance));
  }
  return image;
}

/// Root mean square of the difference within a square around the middle.
float Off(const fsm::Image& a, const fsm::Image& b, int reach) {
  float squares = 0;
  for (int y = 100 - reach; y < 100 + reach; ++y) {
    for (int x = 100 - reach; x < 100 + reach; ++x) {
      squares +=
          std::pow(facefit::Rgb(a, a.Index(x, y)).g - facefit::Rgb(b, b.Index(x, y)).g, 2.0F);
    }
  }
  return std::sqrt(squares) / (2 * static_cast<float>(reach));
}

TEST(NoiseFilterTest, AFilmWithoutNoiseStaysAsItIs) {
  std::mt19937 chance(1);
  NoiseFilter filter;
  for (int k = 0; k < 6; ++k) {
    const fsm::Image picture = Noisy(Pattern(3 * k, k > 3), 1, chance);
    EXPECT_EQ(&filter.Filter(picture, kCrop), &picture);
    EXPECT_FALSE(filter.IsNoisy());
  }
}

TEST(NoiseFilterTest, OfWhatStaysAndOfWhatMovesLittleNoiseIsLeft) {
  for (const int step : {0, 3}) {
    std::mt19937 chance(2);
    NoiseFilter filter;
    float off = 0;
    for (int k = 0; k < 10; ++k) {
      const fsm::Image clean = Pattern(step * k, false), picture = Noisy(clean, 20, chance);
      off = Off(filter.Filter(picture, kCrop), clean, 60);
    }
    EXPECT_TRUE(filter.IsNoisy());
    EXPECT_LT(off, step == 0 ? 9 : 12) << step;
  }
}

TEST(NoiseFilterTest, WhatChangesIsShownAtOnce) {
  std::mt19937 chance(3);
  NoiseFilter filter;
  for (int k = 0; k < 8; ++k) filter.Filter(Noisy(Pattern(0, false), 20, chance), kCrop);
  const fsm::Image clean = Pattern(0, true), picture = Noisy(clean, 20, chance);
  EXPECT_LT(Off(filter.Filter(picture, kCrop), clean, 5), 22);  // 110 where the old one is left
}

TEST(NoiseFilterTest, AFaceAtThePicturesEdgeAndAnotherSizeAreNoMatter) {
  std::mt19937 chance(4);
  NoiseFilter filter;
  for (const float x : {0.0F, -300.0F, 199.0F, 100.0F}) {
    for (int k = 0; k < 3; ++k) {
      const fsm::Image picture = Noisy(Pattern(0, false), 20, chance);
      EXPECT_TRUE(
          filter.Filter(picture, {.centre = {x, 190}, .size = 170, .angle_rad = 0.4F}).IsWhole());
    }
    const fsm::Image small = fsm::FilledImage(20, 30);
    EXPECT_EQ(&filter.Filter(small, kCrop), &small);
  }
}

}  // namespace
}  // namespace facetrack
