// What moves is no cut, however fast and noisy; another picture is one.

#include "face_track/follow/cut_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "face_fit/image/pixels.h"

namespace facetrack {
namespace {

constexpr int kWide = 320, kHigh = 240;

/// A light face with dark hair and eyes before a dark wall, in strong noise; `turned`: pixels by
/// which it and what is on it have gone to the right.
fsm::Image HeadAt(float turned, float skin, std::mt19937& chance) {
  std::normal_distribution<float> noise(0, 25);
  fsm::Image image = fsm::FilledImage(kWide, kHigh);
  facefit::ForEachPixel(kWide, kHigh, [&](int x, int y, std::size_t i) {
    const float u = static_cast<float>(x) - 130 - turned, v = static_cast<float>(y) - 120;
    float grey = 50;
    if (std::hypot(u / 70, v / 95) < 1) grey = v < -55 ? 20 : skin;
    if (std::hypot(std::abs(u - 0.5F * turned) - 28, v + 15) < 10) grey = 25;
    const auto level = [&] { return grey + noise(chance); };
    facefit::SetRgb(image, i, {level(), level(), level()});
  });
  return image;
}

TEST(CutFinderTest, AFastTurnInStrongNoiseIsNoCutToAnotherPerson) {
  std::mt19937 chance(1);
  CutFinder finder;
  EXPECT_FALSE(finder.IsCut(HeadAt(0, 180, chance)));
  for (const float turned : {0.0F, 25.0F, 50.0F, 25.0F, 0.0F}) {
    EXPECT_FALSE(finder.IsCut(HeadAt(turned, 180, chance))) << turned;
  }
}

TEST(CutFinderTest, AnotherPersonInTheSamePlaceIsACut) {
  std::mt19937 chance(2);
  CutFinder finder;
  finder.IsCut(HeadAt(0, 180, chance));
  EXPECT_TRUE(finder.IsCut(HeadAt(0, 110, chance)));
  EXPECT_FALSE(finder.IsCut(HeadAt(0, 110, chance)));
}

}  // namespace
}  // namespace facetrack
