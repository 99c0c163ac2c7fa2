#include "face_fit/bake/skin_rasterizer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/picture/filters.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_wear.h"

namespace facefit {
namespace {

/// The built-in head as if a photo of 300 pixels showed it.
class SkinRasterizerTest : public testing::Test {
 protected:
  void SetUp() override {
    base_.head = fsm::MakeHead("galatea");
    base_.head->Evaluate({}, base_.rest);
    fitted_.posed_vertices = base_.rest.position;
    fitted_.pose.focal = 760;
    fitted_.pose.centre = {150, 150};
    bottom_ = base_.head->Landmark("gnathion").y - 8;
    cover_ = RasterizeSkin(base_, fitted_, fitted_.pose, grid_, bottom_, base_.rest.position);
  }
  bool Covered(int x, int y) const {
    return cover_.depth.at[cover_.depth.Index(x, y)] > SkinRaster::kNone;
  }
  glm::vec2 Pixel(int x, int y) const { return grid_.origin + grid_.cell * glm::vec2(x, y); }
  glm::vec3 Place(int x, int y) const {
    const float depth = cover_.depth.at[cover_.depth.Index(x, y)];
    return fitted_.pose.FromCamera(fitted_.pose.Unproject(Pixel(x, y), depth));
  }
  template <typename F>
  void ForCovered(F f) const {
    for (int y = 0; y < grid_.rows; ++y) {
      for (int x = 0; x < grid_.columns; ++x) {
        if (Covered(x, y)) f(x, y);
      }
    }
  }

  BaseHead base_;
  FittedHead fitted_;
  float bottom_ = 0;
  PhotoGrid grid_{.origin = {10, 10}, .cell = 2, .columns = 140, .rows = 140};
  SkinRaster cover_{FloatImage(0, 0), {FloatImage(0, 0), FloatImage(0, 0), FloatImage(0, 0)}};
};

TEST_F(SkinRasterizerTest, EndsBelowTheChinAndAtTheLineOfTheJaw) {
  int count = 0, low = 0;
  ForCovered([&](int x, int y) {
    const glm::vec3 p = Place(x, y);
    EXPECT_GT(p.y, bottom_ - 0.5F);
    EXPECT_GT(p.z, fsm::JawLine(p.y - bottom_) - 1.5F) << p.x << ' ' << p.y;
    ++count;
    low += p.y < bottom_ + 12 ? 1 : 0;
  });
  EXPECT_GT(count, 2000);
  EXPECT_GT(low, 20) << "the chin is covered";
}

TEST_F(SkinRasterizerTest, MotionIsThatOfThePlaceItself) {
  // Each vertex is moved by its own place.
  float error = 0, count = 0;
  ForCovered([&](int x, int y) {
    const std::size_t i = cover_.depth.Index(x, y);
    const glm::vec3 by(cover_.motion[0].at[i], cover_.motion[1].at[i], cover_.motion[2].at[i]);
    error += glm::distance(by, Place(x, y));
    count += 1;
  });
  EXPECT_LT(error / count, 0.3F);
}

TEST(FillHolesTest, WhatCannotBeReachedFromTheEdgeIsFilled) {
  FloatImage ring(40, 40), open = ring;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const float far = glm::distance(glm::vec2(x, y), glm::vec2(20));
      ring.at[ring.Index(x, y)] = far > 8 && far < 12 ? 1.0F : 0.0F;
      open.at[open.Index(x, y)] = y < 20 && std::abs(x - 20) < 2 ? 0 : ring.at[ring.Index(x, y)];
    }
  }
  FillHoles(ring);
  FillHoles(open);
  EXPECT_EQ(ring.at[ring.Index(20, 20)], 1);
  EXPECT_EQ(ring.at[ring.Index(20, 10)], 1);
  EXPECT_EQ(ring.at[ring.Index(2, 20)], 0);
  EXPECT_EQ(open.at[open.Index(20, 20)], 0) << "a mouth at the edge of the picture";
  EXPECT_EQ(open.at[open.Index(20, 30)], 1);
}

}  // namespace
}  // namespace facefit
