#include <gtest/gtest.h>

#include <cmath>

#include "fsm/motion/face_motion.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

struct FaceMotionTest : testing::Test {
  FaceMotionTest() {
    // The original's fixed time, and both sides alike: so numbers can be told exactly.
    auto settings = motion.settings();
    settings.onset = Onset::kFixed;
    motion.Apply(0ms, settings);
    EXPECT_TRUE(motion.switches().Set(0ms, "ASYMMETRY", 0));
  }
  FaceMotion motion{MotionTables::Load().value(), 7};
};

TEST_F(FaceMotionTest, AnExpressionIsWholeAfterItsOnsetAndHolds) {
  ASSERT_TRUE(motion.expression.Show(0ms, "HAPPY", 1, 1, 0ms));
  EXPECT_FLOAT_EQ(motion.StateAt(0ms).au.left[12], 0);
  EXPECT_FLOAT_EQ(motion.StateAt(100ms).au.left[12], 1.0f);
  EXPECT_FLOAT_EQ(motion.StateAt(1h).au.right[12], 1.0f);
  EXPECT_EQ(motion.SettledAt(0ms), vm::Time(100ms));
  EXPECT_FALSE(motion.NextMotion(100ms).has_value());
}

TEST_F(FaceMotionTest, ATimedExpressionGoesAwayByItself) {
  ASSERT_TRUE(motion.expression.Show(0ms, "ANGRY", 1, 2, 1000ms));
  EXPECT_FLOAT_EQ(motion.StateAt(500ms).au.left[4], 2);
  EXPECT_FLOAT_EQ(motion.StateAt(900ms).au.left[4], 2);
  EXPECT_FLOAT_EQ(motion.StateAt(1000ms).au.left[4], 0);
  EXPECT_EQ(motion.EndsAt(10ms), vm::Time(1000ms));
  EXPECT_EQ(motion.NextMotion(500ms), vm::Time(900ms));
}

TEST_F(FaceMotionTest, AShortExpressionTakesHalfItsTimeForEachFade) {
  ASSERT_TRUE(motion.expression.Show(0ms, "HAPPY", 1, 1, 120ms));
  EXPECT_FLOAT_EQ(motion.StateAt(60ms).au.left[12], 1.0f);
  EXPECT_FLOAT_EQ(motion.StateAt(120ms).au.left[12], 0);
}

TEST_F(FaceMotionTest, ExpressionsCrossfadeWithoutJumps) {
  FaceState before = motion.StateAt(0ms);
  for (vm::Time t = 0ms; t < 1500ms; t += 5ms) {
    if (t == 100ms) {
      ASSERT_TRUE(motion.expression.Show(t, "HAPPY", 1, 1, 0ms));
    }
    if (t == 150ms) {
      ASSERT_TRUE(motion.expression.Show(t, "SURPRISED", 1, 2, 300ms));
    }
    if (t == 200ms) {
      ASSERT_TRUE(motion.expression.Show(t, "SAD", 1, 1, 0ms));
    }
    if (t == 220ms) motion.expression.Neutral(t);
    const FaceState now = motion.StateAt(t);
    for (std::size_t i = 0; i < kActionUnits; ++i) {
      ASSERT_LT(std::abs(now.au.left[i] - before.au.left[i]), 0.25f) << i << " at " << t.count();
    }
    before = now;
  }
  for (const float unit : before.au.left) EXPECT_FLOAT_EQ(unit, 0);
}

TEST_F(FaceMotionTest, NaturalExpressionsTakeTheMeasuredTimesAndLags) {
  auto settings = motion.settings();
  settings.onset = Onset::kPosed;
  motion.Apply(0ms, settings);
  ASSERT_TRUE(motion.expression.Show(0ms, "HAPPY", 5, 1, 0ms));
  EXPECT_LT(motion.StateAt(555ms).au.left[12], 0.8f);
  EXPECT_FLOAT_EQ(motion.StateAt(556ms).au.left[12], 0.8f);
  // Eyes first, then the brow, then the mouth.
  EXPECT_GT(motion.StateAt(8ms).au.left[6], 0);
  EXPECT_FLOAT_EQ(motion.StateAt(8ms).au.left[1], 0);
  EXPECT_GT(motion.StateAt(18ms).au.left[1], 0);
  EXPECT_FLOAT_EQ(motion.StateAt(18ms).au.left[12], 0);
}

TEST_F(FaceMotionTest, UnknownNamesAreRefusedWithWhatThereIs) {
  const auto unknown = motion.expression.Show(0ms, "BORED", 1, 1, 0ms);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().text,
            "'BORED' is no expression; ANGRY DISGUSTED FEARED HAPPY SAD SURPRISED USERDEF or "
            "NEUTRAL expected");
  EXPECT_EQ(motion.expression.Show(0ms, "HAPPY", 9, 1, 0ms).error().text,
            "HAPPY has no pattern 9; 1 to 5 expected");
  EXPECT_EQ(motion.PlayMovement(0ms, "NOD", 6).error().text,
            "NOD has no pattern 6; 1 to 5 expected");
  EXPECT_FALSE(motion.switches().Set(0ms, "USERDEF", 1));
  EXPECT_TRUE(motion.switches().Set(0ms, "USERDEF", 0));
  EXPECT_FALSE(motion.SetListedUnit(0ms, 37, 1));
  EXPECT_FALSE(motion.mouth.Set(0ms, 18, 1));
  EXPECT_FALSE(motion.action_units.Set(0ms, "3 1 0"));
  EXPECT_FALSE(motion.blend_shapes.Set(0ms, "jawSideways", 1, 0ms));
}

TEST_F(FaceMotionTest, WhatMouthNAsksIsKnownFromWhatSpeechAsks) {
  ASSERT_TRUE(motion.mouth.Set(0ms, 12, 0.5));
  const FaceState state = motion.StateAt(1s);
  EXPECT_FLOAT_EQ(state.mouth[kJawY], 7.5F);
  EXPECT_EQ(state.mouth_by_hand, state.mouth);
}

TEST_F(FaceMotionTest, UnitsCanBeMovedOnOneSide) {
  ASSERT_TRUE(motion.action_units.Set(0ms, "12L 0.7 200"));
  EXPECT_NEAR(motion.StateAt(100ms).au.left[12], 0.35f, 1e-5);
  EXPECT_FLOAT_EQ(motion.StateAt(200ms).au.left[12], 0.7f);
  EXPECT_FLOAT_EQ(motion.StateAt(200ms).au.right[12], 0);
}

TEST_F(FaceMotionTest, FacePositionsAreUnitsAndEmotions) {
  ASSERT_TRUE(motion.SetListedUnit(0ms, 30, 1));
  ASSERT_TRUE(motion.SetListedUnit(0ms, 31, 0.5));
  const FaceState state = motion.StateAt(1s);
  EXPECT_FLOAT_EQ(state.au.left[43], 1);
  EXPECT_FLOAT_EQ(state.au.left[12], 0.5f);
}

TEST_F(FaceMotionTest, BlendShapesBecomeUnitsAndGaze) {
  ASSERT_TRUE(motion.blend_shapes.Set(0ms, "mouthSmileLeft", 0.5, 0ms));
  ASSERT_TRUE(motion.blend_shapes.Set(0ms, "eyeLookUpLeft", 1, 0ms));
  const FaceState state = motion.StateAt(1ms);
  EXPECT_FLOAT_EQ(state.au.left[12], 0.5f);
  EXPECT_FLOAT_EQ(state.au.right[12], 0);
  EXPECT_FLOAT_EQ(state.gaze.left[kDown], -25);
  EXPECT_FLOAT_EQ(state.gaze.right[kDown], 0);
}

TEST_F(FaceMotionTest, EyesTurnAndComeBack) {
  motion.eyes.Rotate(0ms, {true, true}, {10, 20}, 1000ms);
  EXPECT_FLOAT_EQ(motion.StateAt(70ms).gaze.left[kDown], 10);
  EXPECT_FLOAT_EQ(motion.StateAt(70ms).gaze.right[kToRight], 20);
  EXPECT_FLOAT_EQ(motion.StateAt(1000ms).gaze.right[kToRight], 0);
  motion.eyes.Rotate(2000ms, {.left = true}, {0, 15}, 0ms);
  EXPECT_FLOAT_EQ(motion.StateAt(9s).gaze.left[kToRight], 15);
  EXPECT_FLOAT_EQ(motion.StateAt(9s).gaze.right[kToRight], 0);
}

TEST_F(FaceMotionTest, ATimedTurnOfOneEyeEndsWhateverTheOtherDoes) {
  motion.eyes.Rotate(0ms, {.left = true}, {10, 20}, 1000ms);
  motion.eyes.Rotate(100ms, {.right = true}, {5, 5}, 0ms);
  EXPECT_EQ(motion.EndsAt(200ms), vm::Time(1000ms));
  motion.eyes.Rotate(300ms, {.left = true}, {5, 5}, 0ms);
  EXPECT_EQ(motion.EndsAt(300ms), vm::Time(300ms));
}

TEST_F(FaceMotionTest, ALargeGazeIsSharedByTheHead) {
  motion.eyes.Gaze(0ms, {0, 30}, 0ms);
  const FaceState early = motion.StateAt(70ms);
  EXPECT_NEAR((early.gaze.left[kToRight] + early.gaze.right[kToRight]) / 2 + early.head_rotation[1],
              30, 1e-3);
  const FaceState late = motion.StateAt(1s);
  EXPECT_NEAR(late.head_rotation[1], (30 - 12) * 0.6, 1e-3);
  EXPECT_NEAR((late.gaze.left[kToRight] + late.gaze.right[kToRight]) / 2 + late.head_rotation[1],
              30, 1e-3);
}

TEST_F(FaceMotionTest, NodOneGoesTenDegreesDownAndBackIn200Ms) {
  ASSERT_TRUE(motion.PlayMovement(0ms, "NOD", 1));
  EXPECT_FLOAT_EQ(motion.StateAt(100ms).head_rotation[0], 10);
  EXPECT_FLOAT_EQ(motion.StateAt(200ms).head_rotation[0], 0);
  EXPECT_EQ(motion.EndsAt(50ms), vm::Time(200ms));
}

TEST_F(FaceMotionTest, DirectionsAndMovementsAddUp) {
  motion.head.TurnTo(0ms, {5, 6, 7});
  motion.head.TurnBy(0ms, {1, 1, 1});
  EXPECT_FLOAT_EQ(motion.StateAt(1s).head_rotation[0], 6);
  ASSERT_TRUE(motion.PlayMovement(1s, "NOD", 1));
  EXPECT_FLOAT_EQ(motion.StateAt(1100ms).head_rotation[0], 16);
  EXPECT_FLOAT_EQ(motion.StateAt(1100ms).head_rotation[2], 8);
  motion.StopMovements(1100ms);
  EXPECT_FLOAT_EQ(motion.StateAt(1180ms).head_rotation[0], 6);
}

TEST_F(FaceMotionTest, ABlinkShutsTheLidsAndOpensThem) {
  ASSERT_TRUE(motion.PlayMovement(0ms, "BLINK", 1));
  EXPECT_FLOAT_EQ(motion.StateAt(90ms).blink.left, 1);
  EXPECT_FLOAT_EQ(motion.StateAt(220ms).blink.left, 0);
  EXPECT_FALSE(motion.NextMotion(220ms).has_value());
}

TEST_F(FaceMotionTest, SeveralBlinksFollowOneAnother) {
  ASSERT_TRUE(motion.PlayMovement(0ms, "BLINK", 1, 1, 3));
  const BlinkPattern& blink = motion.tables().motions.blinks.front();
  const vm::Time length = FromMs(blink.closing_ms + blink.shut_ms + blink.opening_ms);
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(motion.StateAt(i * length + FromMs(blink.closing_ms)).blink.left, 0.9F) << i;
    EXPECT_LT(motion.StateAt(i * length).blink.left, 0.1F) << i;
  }
}

TEST_F(FaceMotionTest, OfTwoMovesAtOneInstantTheFirstIsNotSeen) {
  Track<float> track(0);
  track.MoveTo(100ms, 1, 200ms);
  track.MoveTo(100ms, 0, 200ms);
  for (vm::Time t = 100ms; t < 400ms; t += 20ms) EXPECT_EQ(track.At(t), 0) << InMs(t);
  track.MoveTo(400ms, 1, 0ms);
  track.MoveTo(400ms, 0, 200ms);
  EXPECT_EQ(track.At(400ms), 1) << "a jump has been made";
}

TEST_F(FaceMotionTest, WhatACommandEndsIsRememberedForSprings) {
  Track<float> track(0);
  track.MoveTo(1s, 1, 200ms);
  track.MoveTo(2s, 0, 200ms);
  EXPECT_EQ(track.At(900ms), 0);
  EXPECT_EQ(track.At(1100ms), 0.5F);
  EXPECT_EQ(track.At(1500ms), 1);
  EXPECT_EQ(track.At(2100ms), 0.5F);
  for (int i = 0; i < 1000; ++i) track.MoveTo(5s, static_cast<float>(i), 0ms);
  EXPECT_EQ(track.At(5s), 999) << "of jumps at one instant the last is kept";
  EXPECT_EQ(track.At(2500ms), 0);
}

TEST_F(FaceMotionTest, AutonomousBlinksAreTwoToSixSecondsApart) {
  ASSERT_TRUE(motion.switches().Set(0ms, "BLINK", 1));
  std::optional<vm::Time> last;
  int blinks = 0;
  bool shut = false;
  for (vm::Time t = 0ms; t < 300s; t += 10ms) {
    const bool now = motion.StateAt(t).blink.left > 0.3f;
    if (now && !shut) {
      if (last) {
        EXPECT_GE(t - *last, 1950ms);
        EXPECT_LE(t - *last, 6050ms);
      }
      last = t;
      ++blinks;
    }
    shut = now;
  }
  EXPECT_GE(blinks, 65);
  EXPECT_LE(blinks, 85);
  // Between blinks nothing moves, and the next one is announced.
  const auto next = motion.NextMotion(300s);
  ASSERT_TRUE(next);
  ASSERT_TRUE(motion.switches().Set(300s, "BLINK", 0));
  EXPECT_FALSE(motion.NextMotion(301s).has_value());
}

TEST_F(FaceMotionTest, AutonomousMovementIsSmallSmoothAndSwitchable) {
  EXPECT_FLOAT_EQ(motion.StateAt(5s).head_rotation[1], 0);
  ASSERT_TRUE(motion.switches().Set(0ms, "MOVE", 1));
  ASSERT_TRUE(motion.switches().Set(0ms, "GAZE", 1));
  float most = 0;
  float before = 0;
  for (vm::Time t = 0ms; t < 60s; t += 20ms) {
    const FaceState state = motion.StateAt(t);
    most = std::max(most, std::abs(state.head_rotation[1]));
    EXPECT_LT(std::abs(state.head_rotation[1] - before), 0.08f);
    // The eyes make small jumps and else keep to their place while the head drifts.
    EXPECT_LE(std::abs(state.gaze.left[kToRight] + state.head_rotation[1]), 1.41f);
    before = state.head_rotation[1];
  }
  EXPECT_GT(most, 0.5f);
  EXPECT_LE(most, 1.6f);
  ASSERT_TRUE(motion.switches().Set(60s, "MOVE", 0));
  EXPECT_FLOAT_EQ(motion.StateAt(61s).head_rotation[1], 0);
}

TEST_F(FaceMotionTest, TheSameSeedGivesTheSameLife) {
  FaceMotion same(MotionTables::Load().value(), 7);
  FaceMotion other(MotionTables::Load().value(), 8);
  for (FaceMotion* face : {&motion, &same, &other})
    ASSERT_TRUE(face->switches().Set(0ms, "MOVE", 1));
  EXPECT_EQ(motion.StateAt(7s).head_rotation, same.StateAt(7s).head_rotation);
  EXPECT_NE(motion.StateAt(7s).head_rotation, other.StateAt(7s).head_rotation);
}

TEST_F(FaceMotionTest, StatesStayFiniteUnderManyCommands) {
  std::uint64_t x = 42;
  const auto random = [&x](int n) {
    x = x * 6364136223846793005u + 1442695040888963407u;
    return static_cast<int>((x >> 33) % static_cast<std::uint64_t>(n));
  };
  const char* names[] = {"HAPPY", "SAD", "ANGRY", "FEARED"};
  vm::Time t = 0ms;
  for (int i = 0; i < 5000; ++i) {
    t += std::chrono::milliseconds(random(50));
    switch (random(8)) {
      case 0:
        (void)motion.expression.Show(t, names[random(4)], 1 + random(5), random(200) / 100.0,
                                     std::chrono::milliseconds(random(300)));
        break;
      case 1:
        (void)motion.SetListedUnit(t, 1 + random(36), random(200) / 100.0);
        break;
      case 2:
        motion.eyes.Rotate(t, {.right = random(2) == 0, .left = true},
                           {static_cast<float>(random(30)), static_cast<float>(random(30))},
                           std::chrono::milliseconds(random(200)));
        break;
      case 3:
        motion.head.TurnBy(t, {1, -2, 3});
        break;
      case 4:
        (void)motion.PlayMovement(t, "REFUSE", 1 + random(3));
        break;
      case 5:
        motion.speech.Start(t, vm::ParsePhonemes("a 80 m 60 i 300").value(), t + 20ms);
        break;
      case 6:
        motion.speech.Sync(t, random(500));
        break;
      default:
        motion.speech.Stop(t);
        break;
    }
    const FaceState state = motion.StateAt(t + std::chrono::milliseconds(random(100)));
    for (const float v : state.au.left) ASSERT_TRUE(v >= 0 && v <= 2);
    for (const float v : state.mouth) ASSERT_LT(std::abs(v), 30);
    for (const float v : state.head_rotation) ASSERT_LT(std::abs(v), 150);
    ASSERT_TRUE(state.seal >= 0 && state.seal <= 1.0001f);
  }
}

}  // namespace
}  // namespace fsm
