// The mouth frame by frame from another program: it goes between frames, rests without them, and
// meets other sources by the mixer's table.

#include <gtest/gtest.h>

#include "fsm/motion/face_motion.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kJaw = 11;
constexpr float kSpoken = 0.75F;  // MouthScale 30

class MouthStreamTest : public testing::Test {
 protected:
  void Add(vm::Time at, float jaw, float seal = 0) {
    MouthPose pose;
    pose.mouth[kJaw] = jaw;
    pose.seal = pose.contact = seal;
    ASSERT_TRUE(motion_.AddMouthFrame(0ms, at, pose));
  }
  float Jaw(vm::Time t) const { return motion_.StateAt(t).mouth[kJaw]; }
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

TEST_F(MouthStreamTest, ItBeginsSoftlyAndClosesWhenNoFramesCome) {
  Add(1000ms, 8);
  Add(1020ms, 8);
  EXPECT_EQ(Jaw(939ms), 0);
  EXPECT_GT(Jaw(970ms), 0);
  EXPECT_NEAR(Jaw(1020ms), 8 * kSpoken, 1e-4);
  EXPECT_NEAR(Jaw(1130ms), 8 * kSpoken, 1e-4);  // held
  EXPECT_NEAR(Jaw(1260ms), 0, 1e-3);
  EXPECT_NEAR(motion_.StateAt(1260ms).lip_seal, 1, 0.05);
  EXPECT_EQ(motion_.StateAt(1700ms).lip_seal, 0);
  EXPECT_EQ(motion_.NextActivity(500ms), vm::Time(940ms));
  EXPECT_EQ(motion_.NextActivity(1100ms), vm::Time(1100ms));
  EXPECT_EQ(motion_.NextActivity(1600ms), std::nullopt);
  EXPECT_EQ(motion_.FiniteEnd(0ms), vm::Time(1550ms));
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
  motion_.StopMouthFrames(1490ms);
  EXPECT_NEAR(Jaw(1490ms), before, 1e-4);
  EXPECT_NEAR(Jaw(1490ms + MouthStream::kHold + MouthStream::kClose), 0, 1e-3);
  EXPECT_LT(motion_.FiniteEnd(1490ms), vm::Time(2100ms));
}

TEST_F(MouthStreamTest, TheMouthOfATextGivesWay) {
  motion_.Speak(0ms, vm::ParsePhonemes("aa 3000").value(), 0ms);
  const float text = Jaw(1000ms);
  EXPECT_GT(text, 5);
  for (int i = 0; i < 50; ++i) Add(1500ms + i * 20ms, 2);
  EXPECT_NEAR(Jaw(2000ms), 2 * kSpoken, 1e-3);
  EXPECT_NEAR(Jaw(1000ms), text, 1e-3);
}

TEST_F(MouthStreamTest, ASealClosesWhateverElseOpens) {
  ASSERT_TRUE(motion_.SetUnit(0ms, "26", 1, 0ms));  // jaw drop
  for (int i = 0; i < 50; ++i) Add(1000ms + i * 20ms, 1, 1);
  EXPECT_EQ(motion_.StateAt(1500ms).lip_seal, 1);
  EXPECT_LT(motion_.StateAt(1500ms).au_left[26], 0.01F);
}

}  // namespace
}  // namespace fsm
