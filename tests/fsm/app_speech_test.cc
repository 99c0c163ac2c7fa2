#include <gtest/gtest.h>

#include "tests/fsm/app_support.h"

namespace fsm {
namespace {

TEST(FsmSpeechTest, ReportsComeInTheOriginalsOrder) {
  FsmStage fsm;
  EXPECT_EQ(fsm.Say("prop Speak = AutoOutput"), "");
  EXPECT_EQ(fsm.Say("set LipSync.pho = h 80 a 100"),
            "rep Speak.text = h a|rep Speak.pho = h [80] a [100] |rep Speak.dur = 180|"
            "rep Speak.utt = non|rep Speak.len = 0|rep Speak.stat = PROCESSING|"
            "rep Speak.stat = READY");
  EXPECT_EQ(fsm.Say("set Speak = NOW"), "rep Speak.stat = SPEAKING");
  EXPECT_TRUE(fsm.module.Busy());
  EXPECT_EQ(fsm.Until(179.9), "");
  EXPECT_EQ(fsm.Until(180), "rep Speak.stat = IDLE");
  EXPECT_FALSE(fsm.module.Busy());
  // utt and len of the next list are those of the one before.
  EXPECT_EQ(fsm.Say("set LipSync.pho = o 50"),
            "rep Speak.text = o|rep Speak.pho = o [50] |rep Speak.dur = 50|"
            "rep Speak.utt = h [80] a [100] |rep Speak.len = 180|rep Speak.stat = PROCESSING|"
            "rep Speak.stat = READY");
}

TEST(FsmSpeechTest, NothingIsReportedByDefault) {
  FsmStage fsm;
  EXPECT_EQ(fsm.Say("set LipSync.pho = h[80] a[100]"), "");
  EXPECT_EQ(fsm.Say("set Speak = NOW"), "");
  EXPECT_EQ(fsm.Until(1000), "");
  EXPECT_TRUE(fsm.errors.empty());
}

TEST(FsmSpeechTest, TheSlotsAnswer) {
  FsmStage fsm;
  fsm.Say("set LipSync.pho = h [80] a [100]");
  EXPECT_EQ(fsm.Say("inq Speak"),
            "rep Speak.text = h a|rep Speak.pho = h [80] a [100] |rep Speak.dur = 180|"
            "rep Speak.utt = non|rep Speak.len = 0|rep Speak.stat = READY|"
            "rep Speak.syncoffset = 0");
  EXPECT_EQ(fsm.Say("inq LipSync"), "rep LipSync.pho = h [80] a [100] |rep LipSync.dur = 180");
  EXPECT_EQ(fsm.Say("inq LipSync.pho"), "rep LipSync.pho = h [80] a [100] ");
  EXPECT_EQ(fsm.Say("inq Speak.dur"), "rep Speak.dur = 180");
  EXPECT_EQ(fsm.Say("inq Speak.syncoffset"), "rep Speak.syncoffset = 0");
}

TEST(FsmSpeechTest, LipSyncWhileSpeakingIsRefused) {
  FsmStage fsm;
  fsm.Say("set LipSync.pho = a 500");
  fsm.Say("set Speak = NOW");
  EXPECT_EQ(fsm.Say("set#7 LipSync.pho = o 100"),
            "rep#7 LipSync.pho.error = BUSY speaking; wait for Speak.stat = IDLE or set Speak = "
            "STOP first");
  EXPECT_EQ(fsm.Say("inq Speak.pho"), "rep Speak.pho = a [500] ");
}

TEST(FsmSpeechTest, NowBeforeTheListIsRemembered) {
  FsmStage fsm;
  fsm.Say("prop Speak.stat = AutoOutput");
  EXPECT_EQ(fsm.Say("set Speak = NOW"), "");
  fsm.Until(300);
  EXPECT_EQ(fsm.Say("set LipSync.pho = a 100"),
            "rep Speak.stat = PROCESSING|rep Speak.stat = READY|rep Speak.stat = SPEAKING");
  EXPECT_EQ(fsm.Until(400), "rep Speak.stat = IDLE");
  // It was for that list only.
  EXPECT_EQ(fsm.Say("set LipSync.pho = a 100"),
            "rep Speak.stat = PROCESSING|rep Speak.stat = READY");
}

TEST(FsmSpeechTest, EveryFormOfAStartTimeIsTaken) {
  for (const char* start : {"+ 500", "+500", "@500", "@ 500"}) {
    FsmStage fsm;
    fsm.Say("prop Speak.stat = AutoOutput");
    fsm.Say("set LipSync.pho = a 100");
    EXPECT_EQ(fsm.Say(std::string("set Speak = ") + start), "") << start;
    EXPECT_TRUE(fsm.module.Busy());
    EXPECT_EQ(fsm.Until(499.9), "") << start;
    EXPECT_EQ(fsm.Until(500), "rep Speak.stat = SPEAKING") << start;
    EXPECT_EQ(fsm.Until(600), "rep Speak.stat = IDLE") << start;
  }
  FsmStage fsm;
  fsm.Say("set LipSync.pho = a 100");
  EXPECT_TRUE(fsm.Say("set#1 Speak = SOON").starts_with("rep#1 Speak.error = BAD_VALUE"));
}

TEST(FsmSpeechTest, AStartThatHasPassedJoinsInTheMiddle) {
  FsmStage fsm;
  fsm.Until(1000);
  fsm.Say("prop Speak.stat = AutoOutput");
  fsm.Say("set LipSync.pho = pau 100 a 500");
  EXPECT_EQ(fsm.Say("set Speak = @800"), "rep Speak.stat = SPEAKING");
  EXPECT_EQ(fsm.Until(1399.9), "");
  EXPECT_EQ(fsm.Until(1400), "rep Speak.stat = IDLE");
}

TEST(FsmSpeechTest, StopReportsWhatWasSpokenAndClosesTheMouth) {
  FsmStage fsm;
  fsm.Say("prop Speak = AutoOutput");
  fsm.Say("set LipSync.pho = h 80 a 400 o 400");
  fsm.Say("set Speak = NOW");
  fsm.Until(300);
  EXPECT_EQ(fsm.Say("set Speak = STOP"), "rep Speak.stat = IDLE");
  EXPECT_EQ(fsm.Say("inq Speak.len"), "rep Speak.len = 300");
  EXPECT_EQ(fsm.Say("inq Speak.utt"), "rep Speak.utt = h [80] a [220] ");
  fsm.Until(420);
  EXPECT_NEAR(fsm.Now().mouth[kJawY], 0, 1e-3);
  EXPECT_GT(fsm.Now().seal, 0.999);
  EXPECT_EQ(fsm.Until(2000), "");
}

TEST(FsmSpeechTest, StopEndsAWaitAndForgetsARememberedNow) {
  FsmStage fsm;
  fsm.Say("prop Speak.stat = AutoOutput");
  fsm.Say("set LipSync.pho = a 100");
  fsm.Say("set Speak = + 500");
  EXPECT_EQ(fsm.Say("set Speak = STOP"), "rep Speak.stat = IDLE");
  EXPECT_EQ(fsm.Until(1000), "");
  fsm.Say("set Speak = NOW");
  EXPECT_EQ(fsm.Say("set Speak = STOP"), "rep Speak.stat = IDLE");
  EXPECT_EQ(fsm.Say("set LipSync.pho = a 100"),
            "rep Speak.stat = PROCESSING|rep Speak.stat = READY");
}

TEST(FsmSpeechTest, SyncMovesTheEndAndZeroIsIgnored) {
  FsmStage fsm;
  fsm.Say("prop Speak.stat = AutoOutput");
  fsm.Say("set LipSync.pho = a 2000");
  fsm.Say("set Speak = NOW");
  fsm.Until(1000);
  EXPECT_EQ(fsm.Say("set Speak.sync = 0"), "");
  EXPECT_EQ(fsm.Say("set Speak.sync = 900"), "");
  EXPECT_EQ(fsm.Until(2099.9), "");
  EXPECT_EQ(fsm.Until(2100), "rep Speak.stat = IDLE");
}

TEST(FsmSpeechTest, SyncOffsetIsAddedToWhatTheVoiceSays) {
  FsmStage fsm;
  fsm.Say("prop Speak.stat = AutoOutput");
  fsm.Say("set Speak.syncoffset = 50");
  fsm.Say("set LipSync.pho = a 2000");
  fsm.Say("set Speak = NOW");
  fsm.Until(1000);
  fsm.Say("set Speak.sync = 900");
  EXPECT_EQ(fsm.Until(2050), "rep Speak.stat = IDLE");
}

TEST(FsmSpeechTest, BadListsSayWhere) {
  FsmStage fsm;
  EXPECT_TRUE(
      fsm.Say("set#1 LipSync.pho = a x b 50").starts_with("rep#1 LipSync.pho.error = BAD_VALUE"))
      << fsm.Say("set#1 LipSync.pho = a x b 50");
  EXPECT_EQ(fsm.Say("inq Speak.stat"), "rep Speak.stat = IDLE");
}

TEST(FsmSpeechTest, PhonemesAppearInFramesExactlyTheLeadBeforeTheSound) {
  FsmStage fsm;
  fsm.Say("prop Frame = AutoOutput");
  fsm.Say("set Record.fps = 100");
  fsm.Say("set Record = a.mp4");
  fsm.Say("set LipSync.pho = pau 200 a 200 m 100 pau 200");
  fsm.Say("set Speak = + 500");
  fsm.clock.RunUntil(FromMs(2000));
  std::string first_a, first_m;
  for (const std::string& line : fsm.said) {
    if (first_a.empty() && line.find(" a ") != std::string::npos) first_a = line;
    if (first_m.empty() && line.find(" m ") != std::string::npos) first_m = line;
  }
  EXPECT_TRUE(first_a.starts_with("rep Frame = 66 660 a ")) << first_a;
  EXPECT_TRUE(first_m.starts_with("rep Frame = 86 860 m ")) << first_m;
}

}  // namespace
}  // namespace fsm
