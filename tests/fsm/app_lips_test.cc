#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/fsm/app_support.h"

namespace fsm {
namespace {

constexpr const char* kWideA = "0 0 0 0 0 0 0 0 0 0 0 20 0 0 0 0 0";

/// The jaw in the middle of a long vowel.
float JawOfLongA(FsmStage& fsm) {
  fsm.Say("set LipSync.pho = a 600");
  fsm.Say("set Speak = NOW");
  fsm.clock.RunUntil(fsm.clock.Now() + FromMs(300));
  const float jaw = fsm.Now().mouth[kJawY];
  fsm.clock.RunUntil(fsm.clock.Now() + FromMs(1000));
  return jaw;
}

TEST(LipSlotsTest, ModeShapesNamesAndScaleAreAskedAndSet) {
  FsmStage fsm;
  EXPECT_EQ(fsm.Say("inq LipSync.mode"), "rep LipSync.mode = DOMINANCE");
  EXPECT_EQ(fsm.Say("inq LipSync.shapes"), "rep LipSync.shapes = 28");
  EXPECT_EQ(fsm.Say("set#1 LipSync.mode = sinusoid"), "rep#1 LipSync.mode = sinusoid");
  EXPECT_EQ(fsm.module.motion().settings().lips.mode, LipMode::kSinusoid);
  EXPECT_EQ(fsm.Say("set#1 LipSync.shapes = 14"), "rep#1 LipSync.shapes = 14");
  EXPECT_EQ(fsm.module.motion().settings().lips.visemes, VisemeSetId::k14);
  EXPECT_NE(fsm.Say("set#1 LipSync.shapes = 20").find("14 or 28 expected"), std::string::npos);
  EXPECT_NE(fsm.Say("set#1 LipSync.names = KLINGON")
                .find("'KLINGON' is no list of phoneme names; AUTO FLITE OPEN_JTALK JULIUS ARPABET "
                      "ESPEAK expected"),
            std::string::npos);
}

TEST(LipSlotsTest, AScaleIsForWholeUtterances) {
  FsmStage fsm;
  const float normal = JawOfLongA(fsm);
  fsm.Say("set LipSync.scale = 50 100");
  EXPECT_NEAR(JawOfLongA(fsm), normal / 2, 0.01);
  fsm.Say("set LipSync.scale = SHOUTED");
  EXPECT_NEAR(JawOfLongA(fsm), normal * 1.8, 0.01);
  fsm.Say("set LipSync.scale = NORMAL");
  EXPECT_NEAR(JawOfLongA(fsm), normal, 0.01);
}

TEST(LipSlotsTest, AShapeIsEditedSavedAndBroughtBack) {
  FsmStage fsm;
  fsm.Say("set LipSync.shapes = 14");
  const float normal = JawOfLongA(fsm);
  fsm.Say("save mine = MouthShape.a MouthShape.i");
  EXPECT_TRUE(
      fsm.Say(std::string("set#1 MouthShape.a = ") + kWideA).starts_with("rep#1 MouthShape.a"));
  EXPECT_NEAR(JawOfLongA(fsm), 15, 0.1);
  fsm.Say("rest mine");
  EXPECT_NEAR(JawOfLongA(fsm), normal, 0.01);
  EXPECT_NE(fsm.Say("set#1 MouthShape.a = 1 2 3").find("3 numbers found; 17 mouth parameters"),
            std::string::npos);
  EXPECT_NE(fsm.Say("set#1 MouthShape.q = 1").find("UNKNOWN_SLOT"), std::string::npos);
  EXPECT_NE(fsm.Say("set#1 MouthShape.a = 0 0 0 0 0 0 0 0 0 0 0 1e9 0 0 0 0 0")
                .find("mouth parameter 12 expected, a number from -60 to 60"),
            std::string::npos);
  EXPECT_NEAR(JawOfLongA(fsm), normal, 0.01) << "the face goes on";
}

TEST(LipSlotsTest, TablesOfShapesAreWrittenAndLoaded) {
  char name[] = "/tmp/galatea_shapes_XXXXXX";
  ASSERT_NE(mkdtemp(name), nullptr);
  const std::filesystem::path folder = name;
  const std::string file = (folder / "mine.txt").string();
  FsmStage fsm;
  fsm.Say(std::string("set MouthShape28.ja_a = ") + kWideA);
  EXPECT_EQ(fsm.Say("set#1 SaveMouthShapes = 28 " + file), "rep#1 SaveMouthShapes = 28 " + file);
  EXPECT_EQ(fsm.Say("set#2 SaveMouthShapes = 20 " + file),
            "rep#2 SaveMouthShapes.error = BAD_VALUE there are sets of 14 and of 28 mouth shapes; "
            "14 or 28 expected");
  FsmStage other;
  EXPECT_EQ(other.Say("set#1 MouthShapes = " + file), "rep#1 MouthShapes = " + file);
  EXPECT_NEAR(JawOfLongA(other), 15, 0.1);
  EXPECT_TRUE(other.Say("inq MouthShape28.ja_a").find(kWideA) != std::string::npos);
  other.Say("set Run = INIT");
  EXPECT_LT(JawOfLongA(other), 8);

  std::ofstream(folder / "bad.txt") << "rest 0 0 0\n";
  EXPECT_NE(other.Say("set#1 MouthShapes = " + (folder / "bad.txt").string())
                .find("bad.txt:1: 4 words found"),
            std::string::npos);
  EXPECT_NE(other.Say("set#1 MouthShapes = " + folder.string()).find("UNAVAILABLE cannot read"),
            std::string::npos);
  EXPECT_NE(other.Say("set#1 MouthShapes = /dev/zero").find("is not a regular file"),
            std::string::npos);
  std::filesystem::remove_all(folder);
}

TEST(LipSlotsTest, UnknownPhonemesAreSaidOnceAndSpokenWithClosedLips) {
  FsmStage fsm;
  EXPECT_EQ(fsm.Say("set#1 LipSync.pho = a 200 xyzzy 300 a 200 xyzzy 10"),
            "rep#1 LipSync.pho = a [200] xyzzy [300] a [200] xyzzy [10] ");
  ASSERT_EQ(fsm.errors.size(), 1u);
  EXPECT_NE(fsm.errors[0].find("the phoneme 'xyzzy' is in no table"), std::string::npos);
  fsm.Say("set Speak = NOW");
  fsm.Until(310);
  EXPECT_FLOAT_EQ(fsm.Now().seal, 1);
}

TEST(MouthFrameTest, FramesMoveTheMouthAtTheirTimeAndBadOnesAreNamed) {
  FsmStage fsm;
  const std::string lips = " 0 0 0 0 0 0 0 0 0 0 0 8 0 0 0 0 0 0 0.5";
  EXPECT_EQ(fsm.Say("set#1 MouthFrame.start = @1000"), "rep#1 MouthFrame.start = @1000");
  for (const char* ms : {"0", "100", "200"}) fsm.Say("set MouthFrame = " + (ms + lips));
  EXPECT_TRUE(fsm.module.Busy());
  fsm.clock.RunUntil(FromMs(1150));
  EXPECT_NEAR(fsm.Now().mouth[kJawY], 6, 1e-3);  // three quarters: MouthScale 30
  EXPECT_NEAR(fsm.Now().tongue, 0.5, 1e-3);
  EXPECT_NE(fsm.Say("set#1 MouthFrame = 10 1 2").find("3 numbers found, 20 expected"),
            std::string::npos);
  EXPECT_NE(fsm.Say("set#1 MouthFrame = 10 99 0 0 0 0 0 0 0 0 0 0 8 0 0 0 0 0 0 0.5")
                .find("'99' found, mouth parameter 1 expected, a number from -60 to 60"),
            std::string::npos);
  EXPECT_NE(fsm.Say("set#1 MouthFrame = 10 0 0 0 0 0 0 0 0 0 0 0 8 0 0 0 0 0 2 0")
                .find("'2' found, seal expected, a number from 0 to 1"),
            std::string::npos);
  EXPECT_NE(fsm.Say("set#1 MouthFrame.start = soon").find("error = BAD_VALUE"), std::string::npos);
  EXPECT_EQ(fsm.Say("set#1 MouthFrame.start = STOP"), "rep#1 MouthFrame.start = STOP");
  fsm.clock.RunUntil(FromMs(3000));
  EXPECT_EQ(fsm.Now().mouth[kJawY], 0);
  EXPECT_FALSE(fsm.module.Busy());
}

}  // namespace
}  // namespace fsm
