#include "face_fit/find/head/lip_seam.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

#include "tests/face_fit/find/head/built_in_head_test.h"

namespace facefit {
namespace {

using LipSeamTest = BuiltInHeadTest;

TEST_F(LipSeamTest, SeamTellsTheLipsApart) {
  const auto seam = Seam(rest_);
  ASSERT_TRUE(seam);
  fsm::FaceState open;
  open.asymmetry = 0;
  open.au.left[27] = open.au.right[27] = 1;
  const auto moved = Shown(open);
  for (float along = 0.1F; along < 0.95F; along += 0.1F) {
    const auto& [upper, lower] = seam->EdgesAt(along);
    EXPECT_LT(
        glm::distance(glm::vec2(upper.On(rest_.position)), glm::vec2(lower.On(rest_.position))), 1)
        << "they meet";
    EXPECT_GT(Fall(lower, moved), Fall(upper, moved) + 2) << along;
  }
  const auto& [upper, lower] = seam->EdgesAt(0.5F);
  EXPECT_GT(Fall(lower, moved), Fall(upper, moved) + 20);
  const glm::vec3 right = seam->EdgesAt(0).upper.On(rest_.position),
                  left = seam->EdgesAt(1).upper.On(rest_.position);
  const float width = head_->MeasureMouth({}).width_mm;
  EXPECT_NEAR(left.x - right.x, width, 0.2F * width);
}

TEST_F(LipSeamTest, PartedLipsHaveTwoEdges) {
  fsm::FaceState open;
  open.asymmetry = 0;
  open.au.left[26] = open.au.right[26] = 1;
  const auto moved = Shown(open);
  const auto seam = Seam(moved);
  ASSERT_TRUE(seam);
  const auto& [upper, lower] = seam->EdgesAt(0.5F);
  const float gap = upper.On(moved.position).y - lower.On(moved.position).y;
  EXPECT_GT(gap, 3);
  EXPECT_NEAR(gap, head_->MeasureMouth(open).gap_mm, 3);
}

TEST_F(LipSeamTest, NoLipsNoSeam) {
  EXPECT_FALSE(FindLipSeam(head_->surface(), rest_.position, fsm::SkinTriangles(head_->surface()),
                           false, {}, {}));
  // A forehead has none.
  const std::vector<glm::vec3> above{{-10, 70, 80}, {10, 70, 80}},
      below{{-10, 55, 85}, {10, 55, 85}};
  EXPECT_FALSE(FindLipSeam(head_->surface(), rest_.position, fsm::SkinTriangles(head_->surface()),
                           false, above, below));
}

}  // namespace
}  // namespace facefit
