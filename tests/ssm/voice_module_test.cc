// The adapter suite: everything a client may rely on, against every engine.

#include "ssm/voice/voice_module.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>

#include "ssm/flite/flite_engine.h"
#include "ssm/voice/wav_file.h"
#include "ssm_stub/rule_engine.h"
#include "tests/ssm/voice_world.h"
#include "tests/support/process.h"

namespace ssm_test {
namespace {

using Lines = std::vector<std::string>;
constexpr const char* kText = "Hello, my name is Galatea, and this is a sentence of some length.";

struct EngineCase {
  const char* name;
  std::unique_ptr<ssm::SpeechEngine> (*make)();
};

class VoiceModuleTest : public testing::TestWithParam<EngineCase> {
 protected:
  VoiceWorld world_{GetParam().make()};

  long Prepare(const std::string& text = kText) {
    world_.Tell("set Text = " + text);
    world_.Lines();
    return std::stol(world_.Ask("Text.dur"));
  }
};

INSTANTIATE_TEST_SUITE_P(Engines, VoiceModuleTest,
                         testing::Values(EngineCase{"Stub", ssm_stub::MakeRuleEngine},
                                         EngineCase{"Flite", ssm::MakeFliteEngine}),
                         [](const auto& one) { return std::string(one.param.name); });

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
  world_.Lines();
  world_.Tell("set#3 Text = other");
  EXPECT_TRUE(world_.Lines()[0].starts_with("rep#3 Text.error = BUSY about to speak"));
  world_.Pass(20);
  world_.Lines();
  world_.Tell("set#4 Text = other");
  world_.Tell("set#5 Speak = NOW");
  world_.Tell("set#6 LoadWAV = x.wav");
  const Lines lines = world_.Lines();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_TRUE(lines[0].starts_with("rep#4 Text.error = BUSY speaking"));
  EXPECT_TRUE(lines[1].starts_with("rep#5 Speak.error = BUSY already speaking"));
  EXPECT_TRUE(lines[2].starts_with("rep#6 LoadWAV.error = BUSY "));
  EXPECT_EQ(world_.Ask("Text.text"), kText) << "the refused text left traces";
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

TEST_P(VoiceModuleTest, BadValuesAreRefusedAndChangeNothing) {
  Prepare();
  const struct {
    const char* line;
    const char* code;
  } cases[] = {{"set#1 Speak = SOON", "BAD_VALUE"},
               {"set#1 Speak = +-5", "BAD_VALUE"},
               {"set#1 Speak = @", "BAD_VALUE"},
               {"set#1 Speak = 25:61:00", "BAD_VALUE"},
               {"set#1 Speak = NOW please", "BAD_VALUE"},
               {"set#1 Speaker = nobody", "BAD_VALUE"},
               {"set#1 Speaker =", "BAD_VALUE"},
               {"set#1 Rate = 0", "BAD_VALUE"},
               {"set#1 Rate = nan", "BAD_VALUE"},
               {"set#1 Rate = fast", "BAD_VALUE"},
               {"set#1 Pitch = 3", "BAD_VALUE"},
               {"set#1 Volume = -1", "BAD_VALUE"},
               {"set#1 Speak.syncinterval = -1", "BAD_VALUE"},
               {"set#1 AutoPlay = MAYBE", "BAD_VALUE"},
               {"set#1 Alpha = 0.5", "UNAVAILABLE"},
               {"set#1 Postfilter = 0.3", "UNAVAILABLE"},
               {"set#1 ProsFile = x", "UNAVAILABLE"},
               {"set#1 SavePros = x", "UNAVAILABLE"},
               {"set#1 ParsedText = x", "UNAVAILABLE"},
               {"set#1 Log.chasen = YES", "UNAVAILABLE"},
               {"set#1 Err = /tmp/x", "UNAVAILABLE"},
               {"set#1 SaveWAV = /nowhere/x.wav", "UNAVAILABLE"},
               {"set#1 SaveRAW = /nowhere/x.raw", "UNAVAILABLE"},
               {"set#1 LoadWAV = /nowhere/x.wav", "UNAVAILABLE"},
               {"set#1 Record = /nowhere/x.wav", "UNAVAILABLE"},
               {"set#1 Log = /nowhere/x.log", "UNAVAILABLE"},
               {"set#1 Text.pho = a[10]", "ACCESS"},
               {"set#1 Speak.stat = IDLE", "ACCESS"},
               {"inq#1 Speak", "ACCESS"},
               {"inq#1 Text", "ACCESS"}};
  for (const auto& one : cases) {
    world_.Tell(one.line);
    const Lines lines = world_.Lines();
    ASSERT_EQ(lines.size(), 1u) << one.line;
    EXPECT_NE(lines[0].find(std::string(".error = ") + one.code + " "), std::string::npos)
        << one.line << " -> " << lines[0];
  }
  EXPECT_EQ(world_.Ask("Speak.stat"), "READY");
}

TEST_P(VoiceModuleTest, ATextWithNothingToSayIsAShortPause) {
  for (const char* text : {"", "   ", "\t", "<EMPH></EMPH>"}) {
    world_.Tell(std::string("set Text = ") + text);
    EXPECT_EQ(world_.Ask("Text.pho"), "pau[10]") << "'" << text << "'";
    EXPECT_EQ(world_.Ask("Text.dur"), "10");
    world_.Tell("set Speak = NOW");
    world_.UntilIdle();
    EXPECT_EQ(world_.Ask("Speak.stat"), "IDLE");
    EXPECT_EQ(world_.Ask("Speak.len"), "10");
  }
  for (const char* text : {"!!!", "...", "\xF0\x9F\x98\x80", "—"}) {
    world_.Tell(std::string("set Text = ") + text);
    EXPECT_EQ(world_.Ask("Speak.stat"), "READY") << text;
    EXPECT_TRUE(world_.Ask("Text.pho").starts_with("pau[")) << text;
  }
}

TEST_P(VoiceModuleTest, ATextOverTheLimitIsTooLong) {
  world_.Tell("set#1 Text = " + std::string(ssm::kMaxTextBytes + 1, 'a'));
  EXPECT_TRUE(world_.Lines().at(0).starts_with("rep#1 Text.error = TOO_LONG "));
  EXPECT_EQ(world_.Ask("Speak.stat"), "IDLE");
}

TEST_P(VoiceModuleTest, SilenceTagsTakeTheirTime) {
  const long plain = Prepare("One. Two.");
  const long longer = Prepare("<SILENCE MSEC=\"700\"/>One. Two.<SILENCE MSEC=\"300\"/>");
  EXPECT_EQ(longer, plain + 1000);
}

TEST_P(VoiceModuleTest, RateChangesTheDurationFromTheNextTextOn) {
  const double plain = static_cast<double>(Prepare());
  world_.Tell("set Rate = 2");
  EXPECT_EQ(world_.Lines(), Lines{"rep Rate = 2"});
  EXPECT_NEAR(static_cast<double>(Prepare()), plain / 2, plain * 0.1);
  world_.Tell("set Rate = 0.5");
  EXPECT_NEAR(static_cast<double>(Prepare()), plain * 2, plain * 0.2);
}

TEST_P(VoiceModuleTest, SpeakersOfTheOriginalAreAccepted) {
  EXPECT_EQ(world_.Ask("SpeakerSet"), "slt rms awb kal16 male01 female01 male02");
  for (const char* name : {"male01", "female01", "male02", "slt", "rms", "awb", "kal16"}) {
    world_.Tell(std::string("set Speaker = ") + name);
    EXPECT_EQ(world_.Lines(), Lines{std::string("rep Speaker = ") + name});
    EXPECT_GT(Prepare("Hello."), 100);
  }
}

TEST_P(VoiceModuleTest, SyncComesAtTheIntervalChosen) {
  const long dur = Prepare();
  world_.Tell("set Speak.syncinterval = 0");
  EXPECT_EQ(world_.Lines(), Lines{"rep Speak.syncinterval = 0"});
  world_.Tell("set Speak = NOW");
  world_.UntilIdle();
  EXPECT_EQ(world_.When("tell"), -1);
  world_.Tell("set Speak.syncinterval = 250");
  world_.Lines();
  world_.Tell("set Speak = NOW");
  world_.Pass(600);
  world_.Tell("set Speak.syncinterval = 400");  // in the middle
  world_.UntilIdle();
  Lines ticks;
  for (const std::string& line : world_.Lines()) {
    if (line.starts_with("tell")) ticks.push_back(line);
  }
  ASSERT_GE(dur, 1300);
  ASSERT_GE(ticks.size(), 4u);
  EXPECT_EQ(Lines(ticks.begin(), ticks.begin() + 4),
            (Lines{"tell Speak.sync = 250", "tell Speak.sync = 500", "tell Speak.sync = 800",
                   "tell Speak.sync = 1200"}));
}

TEST_P(VoiceModuleTest, AutoOutputCanBeSwitchedOffByTheSlot) {
  for (const char* slot : {"Speak.utt", "Text.text", "Speak.text", "Speak.pho", "Speak.dur"}) {
    world_.Tell(std::string("prop ") + slot + " = NoAutoOutput");
  }
  world_.Tell("prop Text = NoAutoOutput");  // as in the original, this silences nothing
  world_.Tell("set Text = Hello.");
  const std::string pho = world_.Ask("Text.pho"), dur = world_.Ask("Text.dur");
  EXPECT_EQ(world_.Lines(), (Lines{"rep Speak.stat = PROCESSING", "rep Text.pho = " + pho,
                                   "rep Text.dur = " + dur, "rep Speak.stat = READY"}));
}

TEST_P(VoiceModuleTest, WordsAndMarksComeToThoseWhoAsk) {
  world_.Tell("prop Speak.word = AutoOutput");
  world_.Tell("prop Speak.mark = AutoOutput");
  world_.Tell("set Text = Hello my <BOOKMARK MARK=\"here\"/>friend.");
  world_.Lines();
  world_.Tell("set Speak = NOW");
  world_.UntilIdle();
  Lines words, marks;
  for (const auto& said : world_.said) {
    if (said.line.starts_with("rep Speak.word = ")) {
      words.push_back(said.line);
      const auto blank = said.line.find(' ', 17);
      EXPECT_EQ(std::stod(said.line.substr(blank)), said.ms);
    }
    if (said.line.starts_with("rep Speak.mark = ")) marks.push_back(said.line);
  }
  ASSERT_EQ(words.size(), 3u);
  EXPECT_TRUE(words[2].ends_with(" friend") && words[2].starts_with("rep Speak.word = 3 "));
  ASSERT_EQ(marks.size(), 1u);
  EXPECT_TRUE(marks[0].starts_with("rep Speak.mark = here "));
}

TEST_P(VoiceModuleTest, SpokenWordsTellWhatTheListenerKnows) {
  Prepare("One two three four five six seven eight nine ten.");
  world_.Tell("prop Speak.word = AutoOutput");
  world_.Tell("set Speak = NOW");
  EXPECT_EQ(world_.Ask("Speak.spoken"), "");
  world_.Pass(1200);
  world_.Tell("set Speak = STOP");
  std::string begun;
  for (const Said& said : world_.said) {
    if (!said.line.starts_with("rep Speak.word = ")) continue;
    begun += (begun.empty() ? "" : " ") + said.line.substr(said.line.rfind(' ') + 1);
  }
  EXPECT_GE(std::count(begun.begin(), begun.end(), ' '), 2) << begun;
  EXPECT_EQ(world_.Ask("Speak.spoken"), begun);
}

TEST_P(VoiceModuleTest, AutoPlaySpeaksByItselfInTheOriginalsOrder) {
  world_.Tell("set AutoPlay = YES");
  world_.Tell("set AutoPlayDelay = 30");
  EXPECT_EQ(world_.Lines(), Lines{});
  world_.Tell("set Text = Hello.");
  const double dur = std::stod(world_.Ask("Text.dur"));
  EXPECT_EQ(world_.Ask("Speak.stat"), "SPEAKING");
  world_.UntilIdle();
  EXPECT_EQ(world_.When("rep Speak.stat = IDLE"), 30 + dur);
  const Lines lines = world_.Lines();
  ASSERT_GE(lines.size(), 12u);
  EXPECT_TRUE(lines[6].starts_with("rep Speak.dur"));
  EXPECT_EQ(lines[7], "rep Speak.stat = SPEAKING");
  EXPECT_EQ(lines[8], "rep Speak.stat = READY");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "rep Speak.stat = SPEAKING"), 1);
  EXPECT_EQ(lines.back(), "rep Speak.stat = IDLE");
}

TEST_P(VoiceModuleTest, TextCanBeAppendedTo) {
  world_.Tell("set Text = Hello");
  world_.Tell("set Text << there.");
  EXPECT_EQ(world_.Ask("Text.text"), "Hello there.");
}

TEST_P(VoiceModuleTest, SavedSoundComesBackWithItsPhonemes) {
  const support::TempDir dir;
  const long dur = Prepare();
  const std::string pho = world_.Ask("Text.pho");
  world_.Tell("set SaveWAV = " + dir / "a.wav");
  world_.Tell("set SaveRAW = " + dir / "a.raw");
  EXPECT_EQ(world_.Lines(), Lines{});
  EXPECT_EQ(world_.errors, Lines{});
  const auto wav = ssm::ReadWav(dir / "a.wav");
  const auto raw = ssm::ReadRaw(dir / "a.raw");
  ASSERT_TRUE(wav && raw);
  EXPECT_EQ(wav->size(), ssm::ToFrames(ssm::Millis(dur)));
  EXPECT_EQ(*wav, *raw);

  Prepare("Something else.");
  for (const char* load : {"LoadWAV", "LoadRAW", "SpeechFile"}) {
    const std::string path = dir / (std::string(load) == "LoadWAV" ? "a.wav" : "a.raw");
    world_.Tell(std::string("set ") + load + " = " + path);
    const std::string ms = std::to_string(dur);
    EXPECT_EQ(world_.Lines(),
              (Lines{"rep Speak.stat = PROCESSING", "rep SpeechFile = " + path,
                     "rep Text.pho = " + pho, "rep Speak.pho = " + pho, "rep Text.dur = " + ms,
                     "rep Speak.dur = " + ms, "rep Speak.stat = READY"}));
    world_.Tell("set Speak = NOW");
    world_.UntilIdle();
    EXPECT_EQ(world_.Ask("Speak.len"), ms);
    world_.Lines();
  }
  std::ofstream(dir / "b.wav.info") << "nothing of use\n";
  world_.Tell("set SaveWAV = " + dir / "c.wav");
  std::remove((dir / "c.wav.info").c_str());
  world_.Tell("set#9 LoadWAV = " + dir / "c.wav");
  EXPECT_TRUE(world_.Lines().at(0).starts_with("rep#9 LoadWAV.error = UNAVAILABLE "));
}

TEST_P(VoiceModuleTest, RawSoundIsBigEndian) {
  const support::TempDir dir;
  const std::vector<std::int16_t> samples = {0x0102, -2};
  ASSERT_TRUE(ssm::WriteRaw(dir / "x.raw", samples));
  std::ifstream file(dir / "x.raw", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes, std::string("\x01\x02\xff\xfe", 4));
}

TEST_P(VoiceModuleTest, TheTapeHoldsSpeechExactlyWhereItWasPlayed) {
  const support::TempDir dir;
  Prepare("Hello.");
  world_.Tell("set SaveWAV = " + dir / "speech.wav");
  const auto speech = *ssm::ReadWav(dir / "speech.wav");
  world_.Pass(123);
  world_.Tell("set Record = " + dir / "tape.wav");
  world_.Pass(250);
  world_.Tell("set Speak = +50");
  world_.UntilIdle();
  world_.Pass(100);
  world_.Tell("set Speak = NOW");
  world_.Pass(200);
  world_.Tell("set Speak = STOP");
  world_.Pass(300);
  world_.Tell("set Record = STOP");
  EXPECT_EQ(world_.Ask("Record"), "STOP");
  const auto tape = *ssm::ReadWav(dir / "tape.wav");

  std::vector<std::int16_t> expected(300 * ssm::kFramesPerMs);
  expected.insert(expected.end(), speech.begin(), speech.end());
  expected.resize(expected.size() + 100 * ssm::kFramesPerMs);
  expected.insert(expected.end(), speech.begin(), speech.begin() + 200 * ssm::kFramesPerMs);
  expected.resize(expected.size() + 300 * ssm::kFramesPerMs);
  EXPECT_EQ(tape.size(), expected.size());
  EXPECT_TRUE(tape == expected);
}

TEST_P(VoiceModuleTest, ATapeMayBeginAndEndInTheMiddleOfSpeech) {
  const support::TempDir dir;
  Prepare();
  world_.Tell("set SaveWAV = " + dir / "speech.wav");
  const auto speech = *ssm::ReadWav(dir / "speech.wav");
  world_.Tell("set Speak = NOW");
  world_.Pass(300);
  world_.Tell("set Record = " + dir / "1.wav");
  world_.Pass(400);
  world_.Tell("set Record = " + dir / "2.wav");
  world_.Pass(100);
  world_.module->Shutdown();  // the end of the program closes the tape
  const auto part = [&](int from_ms, int to_ms) {
    return std::vector<std::int16_t>(speech.begin() + from_ms * 16, speech.begin() + to_ms * 16);
  };
  EXPECT_TRUE(*ssm::ReadWav(dir / "1.wav") == part(300, 700));
  EXPECT_TRUE(*ssm::ReadWav(dir / "2.wav") == part(700, 800));
}

TEST_P(VoiceModuleTest, TheLogHasWhatWasChosen) {
  const support::TempDir dir;
  world_.Tell("set Log = " + dir / "log");
  world_.Tell("set Log.text = YES");
  world_.Tell("set Log.phoneme = YES");
  Prepare("Hello.");
  EXPECT_EQ(world_.Ask("Log.text"), "YES");
  world_.Tell("set Log = NO");
  Prepare("Again.");
  std::ifstream file(dir / "log");
  std::string text, phonemes, more;
  std::getline(file, text);
  std::getline(file, phonemes);
  EXPECT_EQ(text, "text: Hello.");
  EXPECT_TRUE(phonemes.starts_with("phoneme: pau["));
  EXPECT_FALSE(std::getline(file, more));
}

TEST_P(VoiceModuleTest, ExitIsReportedAndAskedFor) {
  world_.Tell("set Run = EXIT");
  EXPECT_EQ(world_.Lines(), Lines{"rep Run = EXIT"});
  EXPECT_TRUE(world_.module->ExitRequested());
}

TEST_P(VoiceModuleTest, EverySlotExplainsItself) {
  std::string names = world_.Ask("Slots");
  for (const char* original : {"Run",
                               "ModuleVersion",
                               "ProtocolVersion",
                               "SpeakerSet",
                               "Speaker",
                               "Alpha",
                               "Postfilter",
                               "Text",
                               "Text.text",
                               "Text.pho",
                               "Text.dur",
                               "Speak",
                               "Speak.text",
                               "Speak.pho",
                               "Speak.dur",
                               "Speak.utt",
                               "Speak.len",
                               "Speak.stat",
                               "Speak.syncinterval",
                               "SaveRAW",
                               "Save",
                               "SaveWAV",
                               "LoadRAW",
                               "SpeechFile",
                               "LoadWAV",
                               "SavePros",
                               "LoadPros",
                               "ProsFile",
                               "ParsedText",
                               "AutoPlay",
                               "AutoPlayDelay",
                               "Log",
                               "Log.conf",
                               "Log.text",
                               "Log.arrangedText",
                               "Log.chasen",
                               "Log.tag",
                               "Log.phoneme",
                               "Log.mora",
                               "Log.morph",
                               "Log.aphrase",
                               "Log.breath",
                               "Log.sentence",
                               "Err"}) {
    EXPECT_TRUE(world_.module->slots().Has(original)) << original;
    world_.Tell(std::string("inq ") + original + ".help");
    const Lines lines = world_.Lines();
    ASSERT_EQ(lines.size(), 1u) << original;
  }
}

TEST_P(VoiceModuleTest, AnyOrderOfCommandsEndsIdleWithEveryRequestAnsweredOnce) {
  const char* commands[] = {"Text = Hello there.",
                            "Text = a",
                            "Speak = NOW",
                            "Speak = +70",
                            "Speak = STOP",
                            "Speak = @200",
                            "Rate = 1.5",
                            "Speaker = awb",
                            "AutoPlay = YES",
                            "AutoPlay = NO",
                            "Speak.syncinterval = 90",
                            "Text ="};
  std::mt19937 random(7);
  for (int round = 0; round < 30; ++round) {
    VoiceWorld world(GetParam().make());
    for (int i = 0; i < 40; ++i) {
      world.Tell("set#t" + std::to_string(i) + " " + commands[random() % std::size(commands)]);
      world.Pass(static_cast<double>(random() % 4) * 40);
    }
    world.UntilIdle();
    EXPECT_FALSE(world.module->Busy());
    const std::string stat = world.Ask("Speak.stat");
    EXPECT_TRUE(stat == "IDLE" || stat == "READY") << stat;
    std::size_t speaking = 0, idle = 0;
    for (int i = 0; i < 40; ++i) {
      const std::string tag = "rep#t" + std::to_string(i) + " ";
      EXPECT_EQ(std::count_if(world.said.begin(), world.said.end(),
                              [&](const Said& said) { return said.line.starts_with(tag); }),
                1);
    }
    for (const Said& said : world.said) {
      speaking += said.line == "rep Speak.stat = SPEAKING";
      idle += said.line == "rep Speak.stat = IDLE";
    }
    EXPECT_GE(idle, speaking);
  }
}

}  // namespace
}  // namespace ssm_test
