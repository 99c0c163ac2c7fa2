#include "fsm/base/side.h"

#include <gtest/gtest.h>

#include "fsm/rig/pose.h"

namespace fsm {
namespace {

TEST(SideTest, RightComesFirstAndLiesAtNegativeX) {
  const Sided<int> both{.right = 1, .left = 2};
  EXPECT_EQ(both[Side::kRight], 1);
  EXPECT_EQ(both[Side::kLeft], 2);
  EXPECT_EQ(both.InOrder(), (std::array{1, 2}));
  for (const Side side : kSides) {
    EXPECT_EQ(both.InOrder()[static_cast<std::size_t>(side)], both[side]);
    EXPECT_EQ(SideOfEye(BoneOf(side)), side);
  }
  EXPECT_LT(SignOf(Side::kRight), 0);
  EXPECT_GT(SignOf(Side::kLeft), 0);
}

TEST(AnglesTest, AnEyeLooksDownAndToTheViewersRightByPositiveAngles) {
  const EyeAngles gaze{20, 30};
  const glm::vec3 ahead = EyeRotationOf(gaze)[2];
  EXPECT_LT(ahead.y, -0.3F);
  EXPECT_GT(ahead.x, 0.4F);
  EXPECT_NEAR(GazeOf(EyeRotationOf(gaze))[kDown], 20, 1e-3);
  EXPECT_NEAR(GazeOf(EyeRotationOf(gaze))[kToRight], 30, 1e-3);
}

TEST(AnglesTest, AHeadTurnsDownAndToTheViewersRightByPositiveAngles) {
  FaceState state;
  state.head_rotation = {20, 30, 0};
  const glm::vec3 ahead = HeadRotation(state)[2];
  EXPECT_LT(ahead.y, -0.3F);
  EXPECT_GT(ahead.x, 0.4F);
}

TEST(AnglesTest, HeadRotationsComeBackFromTheirMatrix) {
  for (const Angles& told : {Angles{10, 0, 0}, {0, -20, 0}, {0, 0, 15}, {-25, 40, 30}}) {
    FaceState state;
    state.head_rotation = told;
    const Angles found = HeadRotationOf(HeadRotation(state));
    for (const Axis i : {kDown, kToRight, kTilted}) {
      EXPECT_NEAR(found[i], told[i], 1e-3F) << told[0] << ' ' << told[1] << ' ' << told[2];
    }
  }
}

}  // namespace
}  // namespace fsm
