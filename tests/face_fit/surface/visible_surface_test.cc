#include "face_fit/surface/visible_surface.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

#include "face_fit/surface/rasterizer.h"

namespace facefit {
namespace {

TEST(RasterizeTest, EachPointOfATriangleIsDrawnOnceWithItsWeights) {
  int points = 0;
  Rasterize({{0, 0}, {4, 0}, {0, 4}}, 10, 10, 0, [&](int x, int y, glm::vec3 weights) {
    EXPECT_LE(x + y, 4);
    EXPECT_NEAR(weights.y, static_cast<float>(x) / 4, 1e-6F);
    EXPECT_NEAR(weights.z, static_cast<float>(y) / 4, 1e-6F);
    ++points;
  });
  EXPECT_EQ(points, 15);
}

TEST(RasterizeTest, WhatLiesBeyondTheGridAndWhatHasNoAreaIsNotDrawn) {
  int points = 0;
  const auto count = [&points](int x, int y, glm::vec3) {
    EXPECT_TRUE(x >= 0 && x < 3 && y >= 0 && y < 3) << x << ' ' << y;
    ++points;
  };
  Rasterize({{-5, -5}, {20, -5}, {-5, 20}}, 3, 3, 0, count);
  EXPECT_EQ(points, 9);
  Rasterize({{0, 0}, {1, 1}, {2, 2}}, 3, 3, 0.1F, count);
  Rasterize({{-9, 0}, {-8, 0}, {-9, 1}}, 3, 3, 0.1F, count);
  EXPECT_EQ(points, 9);
}

/// Two squares over each other in an image, the smaller one 5 nearer to the viewer.
class VisibleSurfaceTest : public testing::Test {
 protected:
  static constexpr SampleGrid kGrid{{0, 0}, 1, 12, 12};
  VisibleSurfaceTest() {
    for (const auto& [low, high, z] :
         {std::array{0.0F, 9.0F, 0.0F}, std::array{2.0F, 5.0F, 5.0F}}) {
      screen_.insert(screen_.end(),
                     {{low, low, z}, {low, high, z}, {high, high, z}, {high, low, z}});
    }
  }
  /// Counter-clockwise as they are seen, as y runs down.
  static MeshTriangle Half(std::uint32_t square, std::uint32_t half) {
    const std::uint32_t first = 4 * square;
    return {{first, first + 1 + half, first + 2 + half}, {}};
  }
  std::vector<glm::vec3> screen_;
};

TEST_F(VisibleSurfaceTest, KeepsWhatIsForemostInWhateverOrderItIsDrawn) {
  for (const std::uint32_t first : {0U, 1U}) {
    VisibleSurface surface(kGrid, screen_);
    for (const std::uint32_t square : {first, 1 - first}) {
      for (const std::uint32_t half : {0U, 1U}) surface.DrawFront(Half(square, half));
    }
    EXPECT_EQ(surface.depth()(3, 4), 5);
    EXPECT_EQ(surface.depth()(7, 7), 0);
    EXPECT_EQ(surface.depth()(10, 3), VisibleSurface::kNothing);
    EXPECT_EQ(surface.Covered()(7, 7), 1);
    EXPECT_EQ(surface.Covered()(10, 3), 0);
    ASSERT_TRUE(surface.SampleAt(3, 4));
    EXPECT_GE(surface.SampleAt(3, 4)->triangle.corner[0], 4U) << "of the nearer square";
    EXPECT_EQ(surface.SampleAt(3, 4)->OnMesh().On(screen_), glm::vec3(3, 4, 5));
    EXPECT_FALSE(surface.SampleAt(10, 3));
    EXPECT_FALSE(surface.SampleAt(-1, 3));
    EXPECT_FALSE(surface.SampleAt(3, 12));
  }
}

TEST_F(VisibleSurfaceTest, WhatIsSeenFromBehindIsDrawnOnlyIfAsked) {
  MeshTriangle back = Half(0, 0);
  std::swap(back.corner[1], back.corner[2]);
  VisibleSurface surface(kGrid, screen_);
  surface.DrawFront(back);
  EXPECT_FALSE(surface.SampleAt(2, 7));
  surface.Draw(back);
  EXPECT_TRUE(surface.SampleAt(2, 7));
  VisibleSurface upward(kGrid, screen_, VisibleSurface::Upward::kYes);
  upward.DrawFront(back);
  EXPECT_TRUE(upward.SampleAt(2, 7)) << "where y runs up it is the front";
}

}  // namespace
}  // namespace facefit
