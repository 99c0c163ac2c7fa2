// The mouth frame by frame from another program: it goes between frames, rests without them, and
// meets other sources by the mixer's table.

#include <gtest/gtest.h>

#include "fsm/motion/face_motion.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr float kSpoken = 0.75F;  // MouthScale 30

class MouthStreamTest : public testing::Test {
 protected:
  void Add(vm::Time at, float jaw, float seal = 0) {
    MouthPose pose;
    pose.mouth[kJawY] = jaw;
    pose.seal = pose.contact = seal;
    ASSERT_TRUE(motion_.mouth_stream.Add(0ms, at, pose));
  }
  float Jaw(vm::Time t) const { return motion_.StateAt(t).mouth[kJawY]; }
  FaceMotion motion_{MotionTables::Load().value(), 1};
};

TEST_F(MouthStreamTest, BetweenFramesItGoesStraightAndByMouthScale) {
  for (int i = 0; i < 10; ++i) Add(1000ms + i * 20ms, static_cast<float>(i));
  EXPECT_NEAR(Jaw(1060ms), 3 * kSpoken, 1e-4);
  EXPECT_NEAR(Jaw(1070ms), 3.5F * kSpoken, 1e-4);
  MotionSettings full = motion_.settings();
  full.mouth_scale = kFullMouthScale;
  motion_.Apply(0ms, full);
  EXPECT_NEAR(Jaw(1060ms), 3, 1e-4);
}

TEST_F(MouthStreamTest, AnotherMouthScaleComesAboutWithoutAJump) {
  for (int i = 0; i < 50; ++i) Add(1000ms + i * 20ms, 8);
  MotionSettings small = motion_.settings();
  small.mouth_scale = 0;
  motion_.Apply(1200ms, small);
  EXPECT_NEAR(Jaw(1200ms), 8 * kSpoken, 1e-4);
  EXPECT_NEAR(Jaw(1250ms), 4 * kSpoken, 0.1);
  EXPECT_EQ(Jaw(1300ms), 0);
}

TEST_F(MouthStreamTest, ItBeginsSoftlyAndClosesWhenNoFramesCome) {
  Add(1000ms, 8);
  Add(1020ms, 8);
  EXPECT_EQ(Jaw(939ms), 0);
  EXPECT_GT(Jaw(970ms), 0);
  EXPECT_NEAR(Jaw(1020ms), 8 * kSpoken, 1e-4);
  EXPECT_NEAR(Jaw(1130ms), 8 * kSpoken, 1e-4);  // held
  EXPECT_NEAR(Jaw(1260ms), 0, 1e-3);
  EXPECT_NEAR(motion_.StateAt(1260ms).seal, 1, 0.05);
  EXPECT_EQ(motion_.StateAt(1700ms).seal, 0);
  EXPECT_EQ(motion_.NextMotion(500ms), vm::Time(940ms));
  EXPECT_EQ(motion_.NextMotion(1100ms), vm::Time(1100ms));
  EXPECT_EQ(motion_.NextMotion(1600ms), std::nullopt);
  EXPECT_EQ(motion_.EndsAt(0ms), vm::Time(1550ms));
}

TEST_F(MouthStreamTest, LaterFramesTakeThePlaceOfThoseForTheSameTimes) {
  Add(1000ms, 8);
  Add(1100ms, 8);
  Add(1050ms, 2);
  EXPECT_NEAR(Jaw(1050ms), 2 * kSpoken, 1e-4);
  EXPECT_NEAR(Jaw(1100ms), 2 * kSpoken, 1e-4);
}

TEST_F(MouthStreamTest, StopClosesFromWhereItIs) {
  for (int i = 0; i < 100; ++i) Add(1000ms + i * 20ms, static_cast<float>(i % 10));
  const float before = Jaw(1490ms);
  motion_.mouth_stream.Stop(1490ms);
  EXPECT_NEAR(Jaw(1490ms), before, 1e-4);
  EXPECT_NEAR(Jaw(1490ms + MouthStream::kHold + kMouthCloses), 0, 1e-3);
  EXPECT_LT(motion_.EndsAt(1490ms), vm::Time(2100ms));
}

TEST_F(MouthStreamTest, StopWhileARunTakesTheMouthOverLetsGoFromThere) {
  Add(1000ms, 8);
  Add(1020ms, 8);
  const float before = Jaw(970ms);
  ASSERT_GT(before, 0.5F);
  motion_.mouth_stream.Stop(970ms);
  EXPECT_NEAR(Jaw(970ms), before, 1e-4);
  for (vm::Time t = 970ms; t < 1500ms; t += 10ms) EXPECT_LT(std::abs(Jaw(t + 10ms) - Jaw(t)), 1.5F);
  EXPECT_NEAR(Jaw(1500ms), 0, 1e-3);
}

TEST_F(MouthStreamTest, TheMouthOfATextGivesWay) {
  motion_.speech.Start(0ms, vm::ParsePhonemes("aa 3000").value(), 0ms);
  const float text = Jaw(1000ms);
  EXPECT_GT(text, 5);
  for (int i = 0; i < 50; ++i) Add(1500ms + i * 20ms, 2);
  EXPECT_NEAR(Jaw(2000ms), 2 * kSpoken, 1e-3);
  EXPECT_NEAR(Jaw(1000ms), text, 1e-3);
}

TEST_F(MouthStreamTest, ASealClosesWhateverElseOpens) {
  ASSERT_TRUE(motion_.action_units.Set(0ms, "26 1 0"));  // jaw drop
  for (int i = 0; i < 50; ++i) Add(1000ms + i * 20ms, 1, 1);
  EXPECT_EQ(motion_.StateAt(1500ms).seal, 1);
  EXPECT_LT(motion_.StateAt(1500ms).au.left[26], 0.01F);
}

TEST_F(MouthStreamTest, TheHeadGoesWithTheFramesAndHomeAfterThem) {
  for (int i = 0; i <= 50; ++i) {
    const StreamHead head{{static_cast<float>(i) * 0.1F, -2, 1}, 0.5F};
    ASSERT_TRUE(motion_.mouth_stream.Add(0ms, 1000ms + i * 20ms, MouthPose{}, head));
  }
  const auto at = [this](vm::Time t) { return motion_.StateAt(t); };
  EXPECT_NEAR(at(1510ms).head_rotation[0], 2.55, 0.01);
  EXPECT_NEAR(at(1510ms).head_rotation[1], -2, 0.01);
  EXPECT_NEAR(at(1510ms).head_rotation[2], 1, 0.01);
  EXPECT_NEAR(at(1510ms).au.left[1], 0.5, 0.01);
  EXPECT_NEAR(at(1510ms).au.right[2], 0.4, 0.01);
  // Home within 700 ms, softly.
  for (vm::Time t = 2000ms; t < 2800ms; t += 20ms) {
    EXPECT_LT(std::abs(at(t + 20ms).head_rotation[0] - at(t).head_rotation[0]), 0.25F) << t.count();
  }
  EXPECT_GT(at(2200ms).head_rotation[0], 3);
  EXPECT_EQ(at(2700ms).head_rotation[0], 0);
  EXPECT_EQ(motion_.NextMotion(2690ms), vm::Time(2690ms));
  EXPECT_EQ(motion_.EndsAt(0ms), vm::Time(2700ms));
}

TEST_F(MouthStreamTest, TheHeadOfATextGivesWayToOneThatIsHeard) {
  ASSERT_TRUE(motion_.switches().Set(0ms, "SPEECH", 2));
  motion_.speech.Start(
      0ms, vm::ParsePhonemes("aa 300 m 100 aa 200 m 100 aa 400 m 100 aa 2000").value(), 0ms);
  bool moved = false;
  for (vm::Time t = 100ms; t < 1000ms; t += 50ms)
    moved |= std::abs(motion_.StateAt(t).head_rotation[0]) > 0.5F;
  EXPECT_TRUE(moved);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(
        motion_.mouth_stream.Add(1000ms, 1500ms + i * 20ms, MouthPose{}, StreamHead{{3, 0, 0}, 0}));
  }
  for (vm::Time t = 1500ms; t < 2400ms; t += 50ms) {
    EXPECT_NEAR(motion_.StateAt(t).head_rotation[0], 3, 0.01) << t.count();
  }
  // Frames without a head leave that of the text alone.
  motion_.mouth_stream.Stop(1500ms);
  Add(4000ms, 2);
  Add(4020ms, 2);
  EXPECT_EQ(motion_.StateAt(4010ms).mouth[kJawY], 2 * kSpoken);
}

TEST_F(MouthStreamTest, AMoodIsCoveredByAnExpressionAndComesBack) {
  ASSERT_TRUE(motion_.mood.Set(0ms, "AROUSED", 1));
  const auto brow = [this](vm::Time t) { return motion_.StateAt(t).au.left[5]; };
  EXPECT_EQ(brow(0ms), 0);
  const float mood = brow(1200ms);
  EXPECT_GT(mood, 0.1);
  ASSERT_TRUE(motion_.expression.Show(1200ms, "HAPPY", 2, 1, 0ms));
  EXPECT_NEAR(brow(4000ms), 0, 1e-4);  // HAPPY 2 has no unit 5
  motion_.expression.Neutral(4000ms);
  EXPECT_NEAR(brow(7000ms), mood, 1e-4);
  ASSERT_TRUE(motion_.mood.Set(7000ms, "NEUTRAL", 0));
  EXPECT_NEAR(brow(9000ms), 0, 1e-4);
  EXPECT_EQ(motion_.mood.Set(9000ms, "ODD", 1).error().text,
            "'ODD' is no mood; AROUSED LOW or NEUTRAL expected");
}

}  // namespace
}  // namespace fsm
