#include "face_fit/bake/skin_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

#include "face_fit/image/filters.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_surface.h"

namespace facefit {
namespace {

/// The built-in head as if a photo of 300 pixels showed it.
class SkinSurfaceTest : public testing::Test {
 protected:
  void SetUp() override {
    fitted_.base = &base_;
    fitted_.vertices = base_.rest().position;
    fitted_.pose.focal_px = 1373;
    fitted_.pose.centre_px = {150, 150};
    bottom_ = base_.head().Landmark("gnathion").y - 8;
    skin_.emplace(VisibleSkin(fitted_, fitted_.pose, grid_, bottom_));
  }
  /// By its depth, not as the surface names it.
  glm::vec3 PositionAt(int x, int y) const {
    const FloatImage& depth = skin_->depth();
    return fitted_.pose.PositionOf(grid_.Point(x, y), depth(x, y));
  }
  template <typename F>
  void ForCovered(F f) const {
    for (int y = 0; y < grid_.rows; ++y) {
      for (int x = 0; x < grid_.columns; ++x) {
        if (skin_->SampleAt(x, y)) f(x, y);
      }
    }
  }

  ObservedHead base_ = ObservedHead::Exact(fsm::MakeHead("galatea"), "galatea", {});
  FittedHead fitted_;
  float bottom_ = 0;
  SampleGrid grid_{.origin = {10, 10}, .step = 2, .columns = 140, .rows = 140};
  std::optional<VisibleSurface> skin_;
};

TEST_F(SkinSurfaceTest, EndsBelowTheChinAndAtTheLineOfTheJaw) {
  int count = 0, low = 0;
  ForCovered([&](int x, int y) {
    const glm::vec3 p = PositionAt(x, y);
    EXPECT_GT(p.y, bottom_ - 0.5F);
    EXPECT_GT(p.z, fsm::NeckFrontZ(p.y - bottom_) - 1.5F) << p.x << ' ' << p.y;
    ++count;
    low += p.y < bottom_ + 12 ? 1 : 0;
  });
  EXPECT_GT(count, 2000);
  EXPECT_GT(low, 20) << "the chin is covered";
}

TEST_F(SkinSurfaceTest, NamesThePlaceThatIsForemost) {
  ForCovered([&](int x, int y) {
    const glm::vec3 named = skin_->SampleAt(x, y)->OnMesh().On(base_.rest().position);
    EXPECT_LT(glm::distance(named, PositionAt(x, y)), 0.3F) << x << ' ' << y;
  });
}

TEST(FillHolesTest, WhatCannotBeReachedFromTheEdgeIsFilled) {
  FloatImage ring(40, 40), open = ring;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const float far = glm::distance(glm::vec2(x, y), glm::vec2(20));
      ring(x, y) = far > 8 && far < 12 ? 1.0F : 0.0F;
      open(x, y) = y < 20 && std::abs(x - 20) < 2 ? 0 : ring(x, y);
    }
  }
  FillHoles(ring);
  FillHoles(open);
  EXPECT_EQ(ring(20, 20), 1);
  EXPECT_EQ(ring(20, 10), 1);
  EXPECT_EQ(ring(2, 20), 0);
  EXPECT_EQ(open(20, 20), 0) << "a mouth at the edge of the image";
  EXPECT_EQ(open(20, 30), 1);
}

}  // namespace
}  // namespace facefit
