#include "face_editor/core/player.h"

#include <gtest/gtest.h>

#include <chrono>

namespace editor {
namespace {

using namespace std::chrono_literals;

class PlayerTest : public testing::Test {
 protected:
  PlayerTest() : editor_(std::move(*Editor::Make(""))), player_(*editor_) {}
  std::unique_ptr<Editor> editor_;
  Player player_;
};

TEST_F(PlayerTest, AnExpressionComesStandsAndGoes) {
  Show show;
  show.expression = "HAPPY";
  ASSERT_TRUE(player_.Start(show, false, 10s));
  EXPECT_EQ(player_.At(10s)->au.left[12], 0);
  EXPECT_FLOAT_EQ(player_.At(11s)->au.left[12], 1.0F);
  EXPECT_FALSE(player_.At(20s)) << "it is over";
}

TEST_F(PlayerTest, ALoopBeginsAgainAndCanBeAskedBackwards) {
  Show show;
  show.expression = "HAPPY";
  ASSERT_TRUE(player_.Start(show, true, 0s));
  EXPECT_FLOAT_EQ(player_.At(1s)->au.left[12], 1.0F);
  EXPECT_EQ(player_.At(10ms)->au.left[12], 0);
  EXPECT_TRUE(player_.playing(100s));
  EXPECT_TRUE(player_.At(100s));
}

TEST_F(PlayerTest, WhatIsEditedWhileItPlaysIsSeenAtOnce) {
  Show show;
  show.expression = "HAPPY";
  ASSERT_TRUE(player_.Start(show, false, 0s));
  static_cast<void>(player_.At(900ms));
  fsm::FaceLook look;
  look.au.left[12] = 0.25F;
  ASSERT_TRUE(editor_->SetExpression("HAPPY", 1, look));
  EXPECT_FLOAT_EQ(player_.At(1s)->au.left[12], 0.25F);
}

TEST_F(PlayerTest, WhatIsPlayedMayGoAway) {
  Show show;
  show.motion = "LISTEN";
  show.motion_pattern = 4;
  ASSERT_TRUE(player_.Start(show, true, 0s));
  EXPECT_GT(player_.At(1s)->head_rotation[2], 5);
  ASSERT_TRUE(editor_->RemoveCurve("LISTEN", 4));
  EXPECT_FALSE(player_.At(1s));
}

TEST_F(PlayerTest, SpeechOpensTheMouthAndNamesItsSounds) {
  Show show;
  show.speech = *vm::ParsePhonemes("pau 100 aa 300 m 200 pau 100");
  ASSERT_TRUE(player_.Start(show, false, 0s));
  // 150 ms of rest, and 150 more before the voice.
  EXPECT_EQ(player_.PhonemeAt(600ms), "aa");
  EXPECT_GT(player_.At(550ms)->mouth[fsm::kJawY], 4) << "degrees of the jaw";
  EXPECT_GT(player_.At(780ms)->seal, 0.9F);
}

TEST_F(PlayerTest, WhatTheTablesDoNotHaveIsRefusedAndTheOldPlaysOn) {
  Show good, bad;
  good.expression = "SAD";
  bad.expression = "NOBODY";
  ASSERT_TRUE(player_.Start(good, true, 0s));
  EXPECT_FALSE(player_.Start(bad, true, 0s));
  EXPECT_EQ(player_.show().expression, "SAD");
  EXPECT_TRUE(player_.playing(1s));
}

TEST(StateOfTest, LooksCountTheEyesDownAndStatesUp) {
  fsm::FaceLook look;
  look.au.right[4] = 0.5F;
  look.gaze.left = {6, -2};
  const auto state = StateOf(look);
  EXPECT_EQ(state.au.right[4], 0.5F);
  EXPECT_EQ(state.gaze, look.gaze);
}

}  // namespace
}  // namespace editor
