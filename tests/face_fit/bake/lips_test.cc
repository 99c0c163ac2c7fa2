// Lips that a smile had drawn thin.

#include "face_fit/bake/lips.h"

#include <gtest/gtest.h>

namespace facefit {
namespace {

constexpr glm::vec3 kPlainSkin(205, 165, 145), kRed(190, 105, 105), kShine(250, 245, 240),
    kLine(50, 30, 30);
constexpr int kWide = 120, kHigh = 60;

/// A map whose lips are 16 mm high all along; what it shows of them at a place is for the test to
/// say.
struct Lips {
  fsm::Image map{.width = kWide, .height = kHigh, .rgba = {}};
  SkinTexels texels{kWide, kHigh};

  template <typename F>
  explicit Lips(F colour) {
    for (int y = 0; y < kHigh; ++y) {
      for (int x = 0; x < kWide; ++x) {
        const float within = 8.0F - std::abs(static_cast<float>(y) - 30.0F);
        texels(x, y) = {.within_lips_mm = within};
        const glm::vec3 c = within > 0 ? colour(x, y) : kPlainSkin;
        for (int k = 0; k < 3; ++k) map.rgba.push_back(static_cast<std::uint8_t>(c[k]));
        map.rgba.push_back(255);
      }
    }
  }
  glm::vec3 At(int x, int y) const {
    const std::uint8_t* p = &map.rgba[4 * static_cast<std::size_t>(y * kWide + x)];
    return {p[0], p[1], p[2]};
  }
};

/// Red in the middle, skin to the sides, as a smile leaves it; a shine and the line between the
/// lips.
glm::vec3 AfterSmile(int x, int y) {
  if (y == 30) return kLine;
  if (x == 60) return kShine;
  return x > 40 && x < 80 ? kRed : kPlainSkin;
}

TEST(LipsTest, WhatASmileDrewThinIsRedAgainUpToTheCorners) {
  Lips lips(AfterSmile);
  RestoreLipColour(lips.texels, lips.map);
  for (const int x : {10, 30, 90, 110}) {
    const glm::vec3 c = lips.At(x, 34);
    EXPECT_GT(c.r / c.g, 1.55F) << x;
    EXPECT_LT(c.g, 0.8F * kPlainSkin.g) << x;
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(lips.At(50, 34)[k], kRed[k], 4);
    EXPECT_NEAR(lips.At(60, 34)[k], kShine[k], 1) << "what shines still shines";
    EXPECT_NEAR(lips.At(20, 30)[k], kLine[k], 1) << "the line between the lips stays";
    EXPECT_NEAR(lips.At(20, 50)[k], kPlainSkin[k], 1) << "skin is no lip";
  }
}

TEST(LipsTest, TheBorderIsSoft) {
  Lips lips(AfterSmile);
  RestoreLipColour(lips.texels, lips.map);
  const float edge = lips.At(20, 37).g, inside = lips.At(20, 34).g;
  EXPECT_GT(edge, inside + 10);
  EXPECT_LT(edge, kPlainSkin.g - 3);
}

TEST(LipsTest, LipsNoRedderThanSkinStayAsTheyAre) {
  Lips lips([](int x, int) { return x > 40 && x < 80 ? glm::vec3(120) : glm::vec3(160); });
  const auto before = lips.map.rgba;
  RestoreLipColour(lips.texels, lips.map);
  EXPECT_EQ(lips.map.rgba, before);
}

TEST(LipsTest, AMapWithoutLipsStaysAsItIs) {
  Lips lips(AfterSmile);
  const auto before = lips.map.rgba;
  RestoreLipColour(SkinTexels(kWide, kHigh), lips.map);
  EXPECT_EQ(lips.map.rgba, before);
}

}  // namespace
}  // namespace facefit
