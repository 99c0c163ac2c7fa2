#include "face_fit/image/plane.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/trigonometric.hpp>

namespace facefit {
namespace {

TEST(PlaneTest, ALineGoesOnBeyondItsEndsAtTheirHeight) {
  constexpr std::array<glm::vec2, 3> kLine = {{{0, 1}, {2, 5}, {4, 3}}};
  const auto height = [&](float x) { return LineYAt<glm::vec2>(kLine, x); };
  EXPECT_FLOAT_EQ(height(1), 3);
  EXPECT_FLOAT_EQ(height(2), 5);
  EXPECT_FLOAT_EQ(height(3.5F), 3.5F);
  EXPECT_FLOAT_EQ(height(-9), 1);
  EXPECT_FLOAT_EQ(height(9), 3);
}

TEST(PlaneTest, TwoPointsOverEachOtherHaveAHeight) {
  constexpr std::array<glm::vec2, 2> kUpright = {{{1, 0}, {1, 8}}};
  EXPECT_FLOAT_EQ(LineYAt<glm::vec2>(kUpright, 0), 0);
  EXPECT_FLOAT_EQ(LineYAt<glm::vec2>(kUpright, 2), 8);
}

TEST(PlaneTest, ASegmentIsFarFromWhatLiesBeyondItsEnds) {
  EXPECT_FLOAT_EQ(DistanceToSegment({2, 3}, {0, 0}, {4, 0}), 3);
  EXPECT_FLOAT_EQ(DistanceToSegment({-3, 4}, {0, 0}, {4, 0}), 5);
  EXPECT_FLOAT_EQ(DistanceToSegment({3, 4}, {0, 0}, {0, 0}), 5) << "a point";
}

TEST(PlaneTest, TurnsGoFromXTowardsY) {
  const glm::vec2 turned = Rotated({2, 0}, glm::radians(90.0F));
  EXPECT_NEAR(turned.x, 0, 1e-6F);
  EXPECT_NEAR(turned.y, 2, 1e-6F);
}

TEST(PlaneTest, ABoxHoldsItsPoints) {
  Box2 box;
  for (const glm::vec2 p : {glm::vec2(1, 5), {-1, 2}, {3, 3}}) box.Add(p);
  EXPECT_EQ(box.Middle(), glm::vec2(1, 3.5F));
  EXPECT_EQ(box.Size(), glm::vec2(4, 3));
}

}  // namespace
}  // namespace facefit
