// What outputs of a network mean for a mouth.

#include "vdm/net/mouth_frame.h"

#include <gtest/gtest.h>

#include "tests/vdm/made_net.h"

namespace vdm {
namespace {

Eigen::VectorXf Outputs(float closure, float silence) {
  Eigen::VectorXf outputs = Eigen::VectorXf::Zero(21);
  outputs[18] = closure;
  outputs[19] = silence;
  return outputs;
}

TEST(MouthFrameTest, NumbersAreInTheirOwnUnits) {
  const MouthFrame frame = FrameOf(MadeNet(), Outputs(-8, -8));
  EXPECT_FLOAT_EQ(frame.mouth[11], 2);  // the mean
  EXPECT_EQ(frame.seal, 0);
  EXPECT_NEAR(frame.sounds[0] + frame.sounds[1], 1, 1e-6);
  EXPECT_NEAR(frame.Opening(), 1.4 * 2, 1e-4);
}

TEST(MouthFrameTest, LikelyClosuresSealTheLipsAndPausesBringTheMouthHome) {
  const MouthFrame closed = FrameOf(MadeNet(), Outputs(4, -8));
  EXPECT_EQ(closed.seal, 1);
  EXPECT_NEAR(closed.mouth[11], 2, 0.01);  // p, b, m: the jaw stays
  EXPECT_EQ(closed.Opening(), 0);
  const MouthFrame pause = FrameOf(MadeNet(), Outputs(4, 8));
  EXPECT_NEAR(pause.mouth[11], 0, 0.01);
  const MouthFrame likely = FrameOf(MadeNet(), Outputs(0.6F, -8));
  EXPECT_GT(likely.seal, 0.3);
  EXPECT_LT(likely.seal, 0.7);
  EXPECT_EQ(FrameOf(MadeNet(), Outputs(0, -8)).seal, 0) << "as likely as not";
}

TEST(MouthFrameTest, TheJawDoesNotGoAboveItsRestAndTheTongueStaysInItsRange) {
  Eigen::VectorXf outputs = Outputs(-8, -8);
  outputs[11] = -50;
  outputs[17] = 50;
  const MouthFrame frame = FrameOf(MadeNet(), outputs);
  EXPECT_EQ(frame.mouth[11], 0);
  EXPECT_LE(frame.tongue, 1);
}

/// Feeds a mouth frames of 10 ms in which one sound is heard and the lips are closed or not.
class MouthMotionTest : public testing::Test {
 protected:
  static MouthNet Net() {
    MouthNet net;
    net.sounds = {"sil", "pbm", "td", "aa"};
    net.scales.fill(1);
    net.means[2] = 2;
    net.means[11] = 4;
    return net;
  }
  MouthFrame Hear(std::size_t sound, float closure) {
    Eigen::VectorXf outputs =
        Eigen::VectorXf::Zero(static_cast<Eigen::Index>(net_.first_sound_row() + 4));
    outputs[static_cast<Eigen::Index>(net_.closure_row())] = closure;
    outputs[static_cast<Eigen::Index>(net_.first_sound_row() + sound)] = 8;
    return motion_.Next(outputs);
  }
  /// For how many ms the lips stay sealed while a sound without a closure is heard.
  int SealedMs(std::size_t sound) {
    for (int ms = 0; ms < 1000; ms += 10) {
      if (Hear(sound, -8).seal < 1) return ms;
    }
    return 1000;
  }
  const MouthNet net_ = Net();
  MouthMotion motion_{net_, 10};
};

TEST_F(MouthMotionTest, AClosureHeardForOneFrameLastsWithTheLipsPressed) {
  const float open = Hear(2, -8).mouth[2];
  const MouthFrame closed = Hear(1, 2);
  EXPECT_EQ(closed.seal, 1);
  EXPECT_LT(closed.mouth[2], open - 1);  // the upper lip comes down
  EXPECT_EQ(SealedMs(2), 30);
}

TEST_F(MouthMotionTest, WhereBOrPIsHeardLipsCloseThoughThatIsNotMoreLikelyThanNot) {
  EXPECT_LT(Hear(1, -1.5F).seal, 1);
  EXPECT_LT(Hear(2, -0.5F).seal, 1);
  EXPECT_EQ(Hear(1, -0.5F).seal, 1);
}

TEST_F(MouthMotionTest, AVowelEndsAClosure) {
  Hear(1, 2);
  EXPECT_EQ(SealedMs(3), 10);
}

TEST_F(MouthMotionTest, AClosureThatGoesOnBeingLikelyLastsThroughout) {
  for (int frame = 0; frame < 30; ++frame) EXPECT_EQ(Hear(1, 1).seal, 1);
  EXPECT_EQ(SealedMs(2), 0);
}

TEST_F(MouthMotionTest, TheMouthWaitsInAShortSilenceAndGoesHomeInALongOne) {
  const MouthFrame open = Hear(3, -8);
  for (int frame = 0; frame < 10; ++frame) {
    const MouthFrame stop = Hear(0, 8);
    EXPECT_EQ(stop.seal, open.seal);
    EXPECT_EQ(stop.mouth, open.mouth);
  }
  MouthFrame last;
  for (int frame = 0; frame < 30; ++frame) last = Hear(0, 8);
  EXPECT_GT(last.seal, 0.98F);
  EXPECT_LT(last.mouth[11], 0.1F);
}

TEST_F(MouthMotionTest, ASoundThatBeginsWithSilenceBeginsWithAClosedMouth) {
  EXPECT_EQ(Hear(0, 8).seal, 1);
}

TEST(MouthFrameTest, RoundedLipsStayWithinWhatShapesOfTheMouthReach) {
  Eigen::VectorXf outputs = Outputs(-8, -8);
  outputs[8] = -50;
  EXPECT_EQ(FrameOf(MadeNet(), outputs).mouth[8], -9);
}

}  // namespace
}  // namespace vdm
