// The program as people call it: recordings to tables that fsm takes, tracks to points, and what is
// no recording.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/run.h"

namespace {

using support::Ran;

Ran RunProgram(const std::string& program, std::vector<std::string> words,
               const std::string& input = "") {
  words.insert(words.begin(), GALATEA_BIN_DIR "/" + program);
  return support::RunToEnd(words, input);
}

class FaceSpaceProgramTest : public testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  static std::string Read(const std::string& path) {
    std::ifstream in(path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }
  /// One sentence, which names the program and `what`.
  static void ExpectOneError(const Ran& ran, const std::string& what) {
    EXPECT_EQ(ran.code, 1) << ran.error;
    EXPECT_TRUE(ran.error.starts_with("face_space: ")) << ran.error;
    EXPECT_NE(ran.error.find(what), std::string::npos) << ran.error;
    EXPECT_EQ(std::ranges::count(ran.error, '\n'), 1) << ran.error;
  }

  support::TempDir folder_;
};

TEST_F(FaceSpaceProgramTest, RecordingsBecomeTablesByWhichFsmMoves) {
  const std::string takes = folder_ / "takes", tables = folder_ / "tables";
  const Ran performed = RunProgram("face_space", {"perform", takes, "--units", "1,12", "--mixtures",
                                                  "1", "--rate", "30", "--quiet"});
  ASSERT_EQ(performed.code, 0) << performed.error;
  const Ran units = RunProgram(
      "face_space", {"units", takes + "/au1.csv", takes + "/au12.csv", takes + "/au1+12.csv",
                     "--labels", takes + "/labels.txt", "--places", takes + "/places.txt", "--out",
                     tables, "--vectors-out", folder_ / "vectors.csv", "--quiet"});
  ASSERT_EQ(units.code, 0) << units.error;
  EXPECT_NE(units.out().find("Face vectors"), std::string::npos);
  EXPECT_NE(units.out().find("Recorded12"), std::string::npos) << units.out();
  EXPECT_TRUE(Read(folder_ / "vectors.csv").starts_with("vector,variance,s001_x"));
  const std::string moves = Read(tables + "/moves/motion_1.txt");
  EXPECT_NE(moves.find("set AU = "), std::string::npos);

  const Ran fsm = RunProgram(
      "fsm", {"--headless", "--clock", "virtual", "--size", "64x64", "--tables", tables},
      "set AU = Recorded12 1 0\nset Wait = 100\ninq Frame\n" + moves + "set Run = EXIT\n");
  EXPECT_EQ(fsm.code, 0);
  EXPECT_EQ(fsm.error.find("error"), std::string::npos) << fsm.error;
  EXPECT_EQ(fsm.error.find("not read"), std::string::npos) << fsm.error;
}

TEST_F(FaceSpaceProgramTest, AnArkitTrackIsARecordingToo) {
  std::string track = "ms,jawOpen,mouthSmileLeft,mouthSmileRight\n";
  for (int t = 0; t <= 100; ++t) {
    const double wave = t < 20 || t > 80 ? 0 : std::sin((t - 20) * 3.14159265 / 60);
    track += std::to_string(20 * t) + "," + std::to_string(0.5 * wave) + "," +
             std::to_string(wave) + "," + std::to_string(wave * wave) + "\n";
  }
  const Ran units = RunProgram(
      "face_space", {"units", Write("arkit.csv", track), "--out", folder_ / "tables", "--quiet"});
  EXPECT_EQ(units.code, 0) << units.error;
  EXPECT_NE(units.out().find("Eigen1"), std::string::npos) << units.out();
}

TEST_F(FaceSpaceProgramTest, ATrackOfASmileLandsAtHappy) {
  const std::string track = Write(
      "smile.csv",
      "ms,person,au6L,au6R,au12L,au12R,au25,au26\n0,1,0,0,0,0,0,0\n40,1,0.9,0.9,0.8,0.8,0.7,0.1\n");
  const Ran where = RunProgram("face_space", {"where", track});
  ASSERT_EQ(where.code, 0) << where.error;
  EXPECT_NE(where.out().find("0.0,0.000,0.000,0.000,NEUTRAL,0.00,1.00\n40.0,"), std::string::npos)
      << where.out();
  EXPECT_NE(where.out().find(",HAPPY,"), std::string::npos) << where.out();
  EXPECT_NE(where.error.find("HAPPY 50 %"), std::string::npos) << where.error;
}

TEST_F(FaceSpaceProgramTest, ThePointIsASlotOfFsm) {
  const Ran fsm = RunProgram(
      "fsm", {"--headless", "--clock", "virtual", "--size", "64x64"},
      "set FaceExp.point = 0.5 0 -0.5 200\ninq FaceExp.point\nset FaceExp.point = 3 0 0\n"
      "def FaceExp.point = 12 1\n");
  EXPECT_NE(fsm.out().find("rep FaceExp.point = 0.5 0 -0.5 200"), std::string::npos) << fsm.out();
  EXPECT_NE((fsm.out() + fsm.error).find("FaceExp.point"), std::string::npos);
  EXPECT_NE(fsm.error.find("found '3'"), std::string::npos) << fsm.error;
}

TEST_F(FaceSpaceProgramTest, WhatIsNoRecordingIsOneErrorEach) {
  ExpectOneError(RunProgram("face_space", {"units", folder_ / "none.csv"}), "none.csv");
  ExpectOneError(
      RunProgram("face_space", {"units", Write("words.csv", "ms,a\n0,1\n1,2\n"), "--quiet"}),
      "neither markers");
  ExpectOneError(
      RunProgram("face_space", {"units", Write("nan.csv", "ms,au12L\n0,0\n1,nan\n"), "--quiet"}),
      "nan.csv:3");
  ExpectOneError(
      RunProgram("face_space", {"units", Write("still.csv", "ms,au12L\n0,0\n500,0\n"), "--quiet"}),
      "nothing moves");
  ExpectOneError(RunProgram("face_space", {"where", Write("x.csv", "ms,a\n0,1\n1,2\n")}),
                 "no units");
  const std::string smile = Write("in.csv", "ms,au12L\n0,0\n1,1\n");
  ExpectOneError(RunProgram("face_space", {"where", smile, "--out", smile}),
                 "would be overwritten");
  EXPECT_EQ(Read(smile), "ms,au12L\n0,0\n1,1\n") << "the input is as it was";
  ExpectOneError(RunProgram("face_space", {"emotions"}), "--judge");
}

}  // namespace
