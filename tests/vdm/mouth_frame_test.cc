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
  const MouthFrame half = FrameOf(MadeNet(), Outputs(0, -8));
  EXPECT_GT(half.seal, 0.3);
  EXPECT_LT(half.seal, 0.7);
}

TEST(MouthFrameTest, TheJawDoesNotGoAboveItsRestAndTheTongueStaysInItsRange) {
  Eigen::VectorXf outputs = Outputs(-8, -8);
  outputs[11] = -50;
  outputs[17] = 50;
  const MouthFrame frame = FrameOf(MadeNet(), outputs);
  EXPECT_EQ(frame.mouth[11], 0);
  EXPECT_LE(frame.tongue, 1);
}

}  // namespace
}  // namespace vdm
