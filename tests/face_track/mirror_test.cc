// The module behind the hub: a film in place of a camera moves the agent's face.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "face_fit/find/network/face_networks.h"
#include "tests/stack/stack.h"

namespace {

TEST(MirrorTest, AFilmBeforeTheCameraMovesTheAgentAsAMirrorWould) {
  const auto networks = facefit::FaceNetworks::Load("");
  if (!networks) GTEST_SKIP() << networks.error().text;
  support::TempDir folder;
  const std::string film = folder / "film.mp4";
  support::Process fsm({GALATEA_BIN_DIR "/fsm", "--headless", "--clock", "virtual", "--size",
                        "320x320", "--mask", "memnon"});
  fsm.Write("set Camera = 1 0 25\nset Record.fps = 10\nset Record = " + film +
            "\nset Wait = 600\nset HeadRotAbs.1 = 0 20 0\nset Wait = 1500\nset Record = STOP\n");
  fsm.CloseInput();
  fsm.ReadAll(support::Millis{60000});
  ASSERT_EQ(fsm.Wait(), 0) << fsm.ErrorText();

  stack::Stack stack(
      "real", {{"TRACK", {GALATEA_BIN_DIR "/face_track", "--settle", "300", "--field", "25"}, ""},
               stack::Face()});
  stack.Say("to @FSM set SaveImage = " + stack / "before.bmp");
  stack.Say("to @TRACK prop Track = AutoOutput");
  stack.Say("to @TRACK set Input = " + film);
  stack.Say("to @TRACK set Run = START");
  EXPECT_TRUE(stack.hub().Expect("Track.stat = FOLLOWING", support::Millis{60000}));
  double right = 0;
  while (std::abs(right - 20) > 1.5) {
    const auto line = stack.hub().Expect("\"right\":", support::Millis{60000});
    ASSERT_TRUE(line) << "the last was " << right;
    right = std::atof(line->c_str() + line->find("\"right\":") + 8);
  }
  stack.Say("to @FSM set SaveImage = " + stack / "turned.bmp");
  EXPECT_TRUE(stack.hub().Expect("Input = NONE", support::Millis{60000}));
  stack.Say("to @TRACK set Input = /nothing/here.mp4");
  EXPECT_TRUE(stack.hub().Expect("there is no '/nothing/here.mp4'"));
  stack.Finish();
  EXPECT_TRUE(stack.Text("before.bmp") != stack.Text("turned.bmp"));
  EXPECT_FALSE(stack.Text("turned.bmp").empty());
  EXPECT_NE(stack.Log().find("@FSM set AU = "), std::string::npos);
  // 20 degrees to the viewer's right are two thirds of code 52 in a mirror.
  EXPECT_NE(stack.Log().find("52 0.6"), std::string::npos);
  EXPECT_EQ(stack.Log().find("AU.error"), std::string::npos);
}

}  // namespace
