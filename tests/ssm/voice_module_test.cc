// From a text to speech: the order and the time of reports.

#include "tests/ssm/voice_suite.h"

namespace ssm_test {
namespace {

class VoiceModuleTest : public VoiceSuite {};
INSTANTIATE_TEST_SUITE_P(Engines, VoiceModuleTest, AllEngines(), EngineName);

TEST_P(VoiceModuleTest, GreetsAsTheOriginal) {
  ASSERT_EQ(world_.module->Greeting().size(), 1u);
  EXPECT_EQ(vm::FormatMessage(world_.module->Greeting()[0]), "rep Run = LIVE");
  world_.Tell("inq ProtocolVersion");
  world_.Tell("inq AutoPlayDelay");
  world_.Tell("inq Run");
  EXPECT_EQ(world_.Lines(), (Lines{"rep ProtocolVersion = \"Protocol Ver. 1.0\"",
                                   "rep AutoPlayDelay = \"0\"", "rep Run = LIVE"}));
}

TEST_P(VoiceModuleTest, TextIsReportedInTheOriginalsOrder) {
  world_.Tell("set Text = Hello <RATE SPEED=\"1.5\">there</RATE>.");
  const std::string pho = world_.Ask("Text.pho"), dur = world_.Ask("Text.dur");
  EXPECT_EQ(world_.Lines(), (Lines{"rep Speak.stat = PROCESSING",
                                   "rep Text.text = Hello <RATE SPEED=\"1.5\">there</RATE>.",
                                   "rep Speak.text = Hello there.", "rep Text.pho = " + pho,
                                   "rep Speak.pho = " + pho, "rep Text.dur = " + dur,
                                   "rep Speak.dur = " + dur, "rep Speak.stat = READY"}));
  const auto phonemes = vm::ParsePhonemes(pho);
  ASSERT_TRUE(phonemes);
  EXPECT_EQ(vm::TotalDuration(*phonemes).count(), std::stol(dur));
}

TEST_P(VoiceModuleTest, SpeakingIsReportedInTheOriginalsOrderAndOnTime) {
  const long dur = Prepare();
  ASSERT_GT(dur, 2000);
  world_.Pass(7);
  world_.Tell("set Speak = NOW");
  world_.UntilIdle();
  EXPECT_EQ(world_.When("rep Speak.stat = SPEAKING"), 7);
  EXPECT_EQ(world_.When("tell Speak.sync = 1000"), 1007);
  EXPECT_EQ(world_.When("tell Speak.sync = 2000"), 2007);
  EXPECT_EQ(world_.When("rep Speak.stat = IDLE"), 7.0 + static_cast<double>(dur));
  Lines expected{"rep Speak.stat = SPEAKING"};
  for (long sync = 1000; sync < dur; sync += 1000) {
    expected.push_back("tell Speak.sync = " + std::to_string(sync));
  }
  expected.push_back("rep Speak.len = " + std::to_string(dur));
  expected.push_back("rep Speak.utt = " + world_.Ask("Text.pho"));
  expected.push_back("rep Speak.stat = IDLE");
  EXPECT_EQ(world_.Lines(), expected);
  EXPECT_FALSE(world_.module->Busy());
}

TEST_P(VoiceModuleTest, TheOriginalsShortcutSpeaks) {
  Prepare();
  world_.Tell("o");
  EXPECT_EQ(world_.Lines(), Lines{"rep Speak.stat = SPEAKING"});
}

TEST_P(VoiceModuleTest, StopInTheMiddleTellsThePartSpoken) {
  Prepare();
  for (const int at : {1, 500, 777, 1300}) {
    world_.Tell("set Speak = NOW");
    world_.Pass(at);
    world_.Lines();
    const auto whole = vm::ParsePhonemes(world_.Ask("Text.pho"));
    const std::string part = vm::FormatPhonemesVoice(vm::SpokenPart(*whole, ssm::Millis(at)));
    world_.Tell("set Speak = STOP");
    EXPECT_EQ(world_.Lines(), (Lines{"rep Speak.len = " + std::to_string(at),
                                     "rep Speak.utt = " + part, "rep Speak.stat = IDLE"}));
    EXPECT_FALSE(world_.module->Busy());
    world_.UntilIdle();
    EXPECT_EQ(world_.Lines(), Lines{}) << "something was still said after the stop";
    EXPECT_EQ(world_.Ask("Speak.len"), std::to_string(at));
    world_.Tell("inq Speak.utt");
    EXPECT_EQ(world_.Lines(), Lines{"rep Speak.utt = " + part});
  }
}

TEST_P(VoiceModuleTest, StopBeforeTheStartIsATailOfNothing) {
  Prepare();
  world_.Tell("set Speak = +500");
  EXPECT_TRUE(world_.module->Busy());
  world_.Pass(499);
  world_.Tell("set Speak = STOP");
  const Lines nothing{"rep Speak.len = 0", "rep Speak.utt = ", "rep Speak.stat = IDLE"};
  EXPECT_EQ(world_.Lines(), nothing);
  world_.UntilIdle();
  EXPECT_EQ(world_.Lines(), Lines{});
  Prepare();
  world_.Tell("set Speak = STOP");
  EXPECT_EQ(world_.Lines(), nothing);
}

TEST_P(VoiceModuleTest, StopAfterTheEndKeepsWhatWasSpoken) {
  const long dur = Prepare();
  world_.Tell("set Speak = NOW");
  world_.UntilIdle();
  world_.Lines();
  world_.Tell("set Speak = STOP");
  EXPECT_EQ(world_.Lines(), Lines{"rep Speak.stat = IDLE"});
  EXPECT_EQ(world_.Ask("Speak.len"), std::to_string(dur));
}

TEST_P(VoiceModuleTest, EveryFormOfStartTimeIsKept) {
  Prepare();
  world_.Pass(1000);
  world_.wall = std::chrono::hours(10);
  const struct {
    const char* value;
    double at;
  } cases[] = {{"+250", 1250},          {"+ 250", 1250},        {"@1400.5", 1400.5}, {"@3", 1000},
               {"+00:00:02.500", 3500}, {"10:00:01.750", 2750}, {"NOW", 1000},       {"now", 1000}};
  for (const auto& one : cases) {
    VoiceWorld world(GetParam().make());
    world.wall = std::chrono::hours(10);
    world.Tell("set Text = a");
    world.Pass(1000);
    world.Lines();
    world.Tell(std::string("set Speak = ") + one.value);
    world.UntilIdle();
    EXPECT_EQ(world.When("rep Speak.stat = SPEAKING"), one.at) << one.value;
    EXPECT_EQ(world.When("rep Speak.stat = IDLE"), one.at + std::stod(world.Ask("Text.dur")))
        << one.value;
  }
}

TEST_P(VoiceModuleTest, ASecondStartTimeReplacesTheFirst) {
  Prepare();
  world_.Tell("set Speak = +5000");
  world_.Tell("set Speak = +100");
  world_.UntilIdle();
  EXPECT_EQ(world_.When("rep Speak.stat = SPEAKING"), 100);
  const auto lines = world_.Lines();
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "rep Speak.stat = SPEAKING"), 1);
}

TEST_P(VoiceModuleTest, TheSameTextMayBeSpokenAgain) {
  const long dur = Prepare();
  for (int i = 0; i < 3; ++i) {
    world_.Tell("set Speak = NOW");
    world_.UntilIdle();
    EXPECT_EQ(world_.Ask("Speak.len"), std::to_string(dur));
  }
}

TEST_P(VoiceModuleTest, WhatCannotBeDoneNowIsBusy) {
  world_.Tell("set#1 Speak = NOW");
  EXPECT_EQ(world_.Lines(),
            Lines{"rep#1 Speak.error = BUSY there is nothing to speak; set Text first"});
  world_.Tell("set#2 SaveWAV = /tmp/x.wav");
  EXPECT_TRUE(world_.Lines()[0].starts_with("rep#2 SaveWAV.error = BUSY "));
  Prepare();
  world_.Tell("set Speak = +10");
  world_.Pass(20);
  world_.Lines();
  world_.Tell("set#5 Speak = NOW");
  world_.Tell("set#6 LoadWAV = x.wav");
  const Lines lines = world_.Lines();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_TRUE(lines[0].starts_with("rep#5 Speak.error = BUSY already speaking"));
  EXPECT_TRUE(lines[1].starts_with("rep#6 LoadWAV.error = BUSY "));
}

TEST_P(VoiceModuleTest, TaggedRequestsAreAnsweredOnceAndLast) {
  world_.Tell("set#a Text = Hello.");
  Lines lines = world_.Lines();
  EXPECT_EQ(lines.back(), "rep#a Text = Hello.");
  EXPECT_EQ(lines[lines.size() - 2], "rep Speak.stat = READY");
  world_.Tell("set#b Speak = NOW");
  EXPECT_EQ(world_.Lines(), (Lines{"rep Speak.stat = SPEAKING", "rep#b Speak = NOW"}));
  world_.Tell("set#c Speak = STOP");
  EXPECT_EQ(world_.Lines().back(), "rep#c Speak = STOP");
}

}  // namespace
}  // namespace ssm_test
