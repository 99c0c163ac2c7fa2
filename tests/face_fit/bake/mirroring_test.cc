// The side of a face that the photo does not show.

#include "face_fit/bake/mirroring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace facefit {
namespace {

constexpr int kHalvedSide = 256;

/// A face whose right half is lit orange and whose left one blue, with freckles that are the same
/// on both.
glm::vec3 Lit(int x, int y) {
  const int from_middle = std::abs(2 * x + 1 - kHalvedSide) / 2;
  const float freckle = (from_middle / 4 + y / 4) % 5 == 0 ? 0.8F : 1.0F;
  return freckle * (x < kHalvedSide / 2 ? glm::vec3(220, 140, 90) : glm::vec3(110, 120, 200));
}

struct MirroringTest : testing::Test {
  MirroringTest() {
    for (int y = 0; y < kHalvedSide; ++y) {
      for (int x = 0; x < kHalvedSide; ++x) {
        const glm::vec3 c = Lit(x, y);
        for (int k = 0; k < 3; ++k) map.rgba.push_back(static_cast<std::uint8_t>(c[k]));
        map.rgba.push_back(255);
      }
    }
    // A wing of the nose that the photo does not show, black until it is completed.
    for (int y = kLow; y < kHigh; ++y) {
      for (int x = kLow; x < kHigh; ++x) {
        seen(x, y) = 0;
        for (std::size_t c = 0; c < 3; ++c) map.rgba[4 * seen.Index(x, y) + c] = 0;
      }
    }
  }
  glm::vec3 At(int x, int y) const {
    const std::uint8_t* p = &map.rgba[4 * seen.Index(x, y)];
    return {p[0], p[1], p[2]};
  }

  static constexpr int kLow = 150, kHigh = 170;
  fsm::Image map{.width = kHalvedSide, .height = kHalvedSide, .rgba = {}};
  FloatImage seen{kHalvedSide, kHalvedSide, 1};
  Mask skin{kHalvedSide, kHalvedSide, 1};
};

TEST_F(MirroringTest, WhatIsTakenFromTheOtherSideStandsInTheLightOfItsOwn) {
  CompleteByMirroring(skin, map, seen);
  for (int y = kLow; y < kHigh; ++y) {
    for (int x = kLow; x < kHigh; ++x) {
      EXPECT_LT(glm::distance(At(x, y), Lit(x, y)), 8) << x << " " << y;
      EXPECT_GT(seen(x, y), 0);
    }
  }
}

TEST_F(MirroringTest, WhatWasSeenStaysAsItIs) {
  CompleteByMirroring(skin, map, seen);
  for (int x = 0; x < kHalvedSide; ++x) {
    EXPECT_LT(glm::distance(At(x, 100), glm::floor(Lit(x, 100))), 1.8F) << x;
  }
}

TEST_F(MirroringTest, AHighlightOfTheOtherSideAloneIsNotTakenOver) {
  for (int y = kLow; y < kHigh; ++y) {
    for (int x = kLow; x < kHigh; ++x) {
      std::uint8_t* p = &map.rgba[4 * seen.Index(kHalvedSide - 1 - x, y)];
      for (int c = 0; c < 3; ++c) p[c] = 255;
    }
  }
  CompleteByMirroring(skin, map, seen);
  for (int y = kLow; y < kHigh; ++y) {
    for (int x = kLow; x < kHigh; ++x) {
      EXPECT_LT(At(x, y).r, 1.2F * Lit(200, 2).r) << x << " " << y;
    }
  }
}

TEST_F(MirroringTest, NothingIsTakenWithinEyesAndMouth) {
  skin = Mask(kHalvedSide, kHalvedSide, 0);
  CompleteByMirroring(skin, map, seen);
  EXPECT_EQ(At(160, 160), glm::vec3(0));
}

}  // namespace
}  // namespace facefit
