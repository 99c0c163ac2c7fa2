// The program on films of a built-in head whose turns are known, and on what is no film.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "face_fit/find/network/face_networks.h"
#include "face_track/model/seen_face.h"
#include "tests/support/process.h"

namespace {

struct Ran {
  int code = -1;
  std::vector<std::string> lines;
  std::string error;
};

Ran Track(std::vector<std::string> words) {
  words.insert(words.begin(), GALATEA_BIN_DIR "/face_track");
  support::Process program(words);
  program.CloseInput();
  Ran ran;
  ran.lines = program.ReadAll(support::Millis{120000});
  ran.code = program.Wait().value_or(-1);
  ran.error = program.ErrorText();
  return ran;
}

std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

class FaceTrackTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto networks = facefit::FaceNetworks::Load("");
    if (!networks) GTEST_SKIP() << networks.error().text;
  }
  support::TempDir folder_;
};

TEST_F(FaceTrackTest, TurnsOfAHeadAreFollowed) {
  const std::string film = folder_ / "film.mp4";
  support::Process fsm({GALATEA_BIN_DIR "/fsm", "--headless", "--clock", "virtual", "--size",
                        "480x480", "--mask", "baucis"});
  fsm.Write("set Record.fps = 25\nset Record = " + film +
            "\nset Wait = 1200\nset HeadRotAbs.1 = 0 20 0\nset Wait = 1000\nset Record = STOP\n");
  fsm.CloseInput();
  fsm.ReadAll(support::Millis{120000});
  ASSERT_EQ(fsm.Wait(), 0) << fsm.ErrorText();
  const Ran ran = Track({film, "--field", "25", "--quiet"});
  ASSERT_EQ(ran.code, 0) << ran.error;
  ASSERT_GT(ran.lines.size(), 50U);
  const auto names = CellsOf(ran.lines[0]), first = CellsOf(ran.lines[20]),
             last = CellsOf(ran.lines.back());
  ASSERT_EQ(names.size(), last.size());
  ASSERT_EQ(names[4], "right");
  const double turned = std::stod(last[4]) - std::stod(first[4]);
  std::printf("told 20 degrees to the right, seen %.2f\n", turned);
  EXPECT_NEAR(turned, 20, 2.5);
}

TEST_F(FaceTrackTest, WhatIsNoFilmIsOneError) {
  std::ofstream(folder_ / "text.mp4") << "no film\n";
  const Ran text = Track({folder_ / "text.mp4"}), none = Track({folder_ / "none.mp4"}),
            empty = Track({folder_.path()});
  for (const Ran* ran : {&text, &none, &empty}) {
    EXPECT_EQ(ran->code, 1);
    EXPECT_TRUE(ran->lines.empty());
  }
  EXPECT_NE(text.error.find("is no film with a picture"), std::string::npos) << text.error;
  EXPECT_NE(none.error.find("there is no"), std::string::npos) << none.error;
  EXPECT_NE(empty.error.find("holds no .png"), std::string::npos) << empty.error;
}

TEST(SeenFaceTest, AnglesComeBackFromTurns) {
  const fsm::Angles told{12, -25, 7};
  const fsm::Angles back = facetrack::AnglesOf(facetrack::TurnOf(told));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(back[k], told[k], 1e-3);
}

}  // namespace
