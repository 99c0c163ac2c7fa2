#include "face_fit/find/head/lid_edges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "tests/face_fit/find/head/built_in_head_test.h"

namespace facefit {
namespace {

using LidEdgesTest = BuiltInHeadTest;

TEST_F(LidEdgesTest, LidEdgesLieBesideTheEyeballInOrder) {
  for (const fsm::Side side : fsm::kSides) {
    const auto edges = Lids(rest_, side);
    ASSERT_TRUE(edges) << fsm::SignOf(side);
    const float radius = head_->surface().eyes[side].ball_radius;
    const glm::vec3 outer = edges->outer.On(rest_.position),
                    inner = edges->inner.On(rest_.position);
    EXPECT_GT(std::abs(outer.x), std::abs(inner.x) + 20);
    float before = std::abs(outer.x);
    for (std::size_t k = 0; k < LidEdges::kBetween; ++k) {
      const glm::vec3 above = edges->upper[k].On(rest_.position),
                      below = edges->lower[k].On(rest_.position);
      EXPECT_GT(above.y, below.y) << k;
      EXPECT_LT(std::abs(above.x), before) << k;
      before = std::abs(above.x);
      for (const glm::vec3 p : {above, below}) {
        EXPECT_LT(std::abs(glm::distance(p, head_->EyeCentre(side)) - radius), 3) << k;
      }
    }
  }
}

TEST_F(LidEdgesTest, UpperEdgeFallsWhenTheEyeCloses) {
  const auto edges = Lids(rest_, fsm::Side::kRight);
  ASSERT_TRUE(edges);
  fsm::FaceState shut;
  shut.blink.right = 1;
  const auto moved = Shown(shut);
  const std::size_t middle = LidEdges::kBetween / 2;
  const float opening =
      edges->upper[middle].On(rest_.position).y - edges->lower[middle].On(rest_.position).y;
  EXPECT_GT(Fall(edges->upper[middle], moved), 0.7F * opening);
  EXPECT_LT(Fall(edges->lower[middle], moved), 0.1F);
}

TEST_F(LidEdgesTest, ShutEyesHaveNoEdges) {
  fsm::FaceState shut;
  shut.blink.right = shut.blink.left = 1;
  EXPECT_FALSE(Lids(Shown(shut), fsm::Side::kRight));
}

}  // namespace
}  // namespace facefit
