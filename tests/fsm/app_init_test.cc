// `Run = INIT` leaves nothing of what was said before.

#include <gtest/gtest.h>

#include <chrono>
#include <map>
#include <sstream>
#include <vector>

#include "tests/fsm/app_support.h"
#include "tests/fsm/onlooker.h"
#include "tests/fsm/render_support.h"

namespace fsm {
namespace {

std::vector<std::string> Words(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

std::vector<std::string> SlotsOf(FsmStage& fsm) {
  return Words(fsm.Say("inq Slots").substr(std::string("rep Slots = ").size()));
}

bool Is(FsmStage& fsm, const std::string& slot, const char* access) {
  return fsm.Say("inq " + slot + ".prop").find(access) != std::string::npos;
}

/// What every slot that can be asked answers, by its name.
std::map<std::string, std::string> Answers(FsmStage& fsm) {
  std::map<std::string, std::string> answers;
  for (const std::string& slot : SlotsOf(fsm)) {
    if (!Is(fsm, slot, "WriteOnly")) answers[slot] = fsm.Say("inq " + slot);
  }
  return answers;
}

/// Which slots answer otherwise in one than in the other, and what; "" = none.
std::string Difference(FsmStage& a, FsmStage& b) {
  const auto ours = Answers(a), theirs = Answers(b);
  std::string text;
  for (const auto& [slot, answer] : ours) {
    const auto other = theirs.find(slot);
    if (other == theirs.end()) {
      text += slot + " is in the first only\n";
    } else if (other->second != answer) {
      text += "'" + answer + "', '" + other->second + "'\n";
    }
  }
  for (const auto& [slot, answer] : theirs) {
    if (!ours.contains(slot)) text += slot + " is in the second only\n";
  }
  return text;
}

/// A value that each slot does not have at the start. `files`: where there are or will be some.
std::string Another(const std::string& slot, const TemporaryFolder& files,
                    const Onlooker& onlooker) {
  const std::map<std::string, std::string> values = {
      {"AU", "12 1 0"},
      {"ARKit", "jawOpen 1 0"},
      {"FaceExp", "HAPPY 1 100 0"},
      {"FaceExp.onset", "500"},
      {"HeadRotAbs.1", "10 20 30"},
      {"HeadRotRel.1", "1 2 3"},
      {"FaceMot", "NOD 1 100 20"},
      {"EyeRot", "5 6 0"},
      {"EyeRotRight", "5 6 0"},
      {"EyeRotLeft", "5 6 0"},
      {"Autonomous", "BLINK 1"},
      {"Life", "LIVELY"},
      {"Gaze", "20 20"},
      {"Gaze.distance", "300"},
      {"LipSync.pho", "a 5000"},
      {"MouthFrame", "500 0 0 0 0 0 0 0 0 0 0 0 8 0 0 0 0 0 0 1"},
      {"MouthFrame.start", "@200"},
      {"LipSync", "i 5000"},
      {"Speak", "NOW"},
      {"Speak.sync", "100"},
      {"Speak.syncoffset", "50"},
      {"Speak.syncrate", "80"},
      {"Offset", "70"},
      {"LipSync.lead", "90"},
      {"LipSync.language", "EN"},
      {"MouthScale", "90"},
      {"LipSync.mode", "LINEAR"},
      {"LipSync.shapes", "14"},
      {"LipSync.names", "ARPABET"},
      {"LipSync.scale", "SHOUTED"},
      {"MouthShapes", files / "shapes.txt"},
      {"SaveMouthShapes", "28 " + (files / "more.txt")},
      {"AgentEnable", "DISABLE"},
      {"Asymmetry", "250"},
      {"AgentAlpha", "0.3"},
      {"AgentRot", "10 20 30"},
      {"AgentTrans", "40 50"},
      {"AgentScale", "2"},
      {"Mask", "pygmalion"},
      {"Background", "transparent"},
      {"ViewMode", "WIREFRAME"},
      {"ViewBackground", "DISABLE"},
      {"Simulation", "DISABLE"},
      {"Window", "320 240"},
      {"Picture.fps", "10"},
      {"Picture.to", "unix:" + onlooker.path()},
      {"Camera", "0.5 10 40 20"},
      {"Light.key", "3 90 10 #ff0000"},
      {"Light.fill", "3"},
      {"Light.rim", "0"},
      {"LipSync.text", "Hello!"},
      {"Mood", "LOW 0.5"},
      {"SaveImage", files / "face.png"},
      {"Record.sound", "voice.wav"},
      {"Record.fps", "10"},
      {"Record", "before.mp4"},
      {"Frame.to", "VMC"},
      {"Capture", (files / "shots") + " a 10"},
      {"FaceExp.point", "0.5 0.2 0"},
  };
  if (const auto found = values.find(slot); found != values.end()) return found->second;
  if (slot.starts_with("Face.") || slot.starts_with("Mouth.")) return "50";
  if (slot.starts_with("FaceExp.")) return "4 1";
  if (slot.starts_with("MouthShape")) return "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17";
  return "";
}

/// Numbers of what is drawn.
std::vector<float> Numbers(const FaceState& state) {
  std::vector<float> all;
  for (const auto& units : {state.au.left, state.au.right}) {
    all.insert(all.end(), units.begin(), units.end());
  }
  all.insert(all.end(), state.mouth.begin(), state.mouth.end());
  for (const auto& turn : {state.head_rotation, state.figure.rotation}) {
    all.insert(all.end(), turn.begin(), turn.end());
  }
  for (const float number :
       {state.seal, state.tongue, state.gaze.left[kDown], state.gaze.left[kToRight],
        state.gaze.right[kDown], state.gaze.right[kToRight], state.blink.left, state.blink.right,
        state.head_forward_mm, state.asymmetry, state.figure.translation[0],
        state.figure.translation[1], state.figure.scale, state.figure.alpha,
        state.figure.enabled ? 1.0F : 0.0F}) {
    all.push_back(number);
  }
  return all;
}

/// Commands that must have the same effects in two modules after INIT as at the start.
std::vector<std::vector<float>> Performance(FsmStage& fsm) {
  std::vector<std::vector<float>> states = {Numbers(fsm.Now())};
  fsm.Say("set LipSync.pho = a 300 m 100 ae 300");
  fsm.Say("set FaceExp = HAPPY 1 100 0");
  fsm.Say("set Gaze = 10 5");
  fsm.Say("set Speak = NOW");
  const double begin = std::chrono::duration<double, std::milli>(fsm.clock.Now()).count();
  for (int k = 1; k <= 10; ++k) {
    fsm.Until(begin + 100 * k);
    states.push_back(Numbers(fsm.Now()));
  }
  return states;
}

TEST(InitTest, EverySlotIsAsInAFreshProgram) {
  const TemporaryFolder files;
  const Onlooker onlooker;
  FsmStage used, fresh;
  used.Say("set SaveMouthShapes = 28 " + (files / "shapes.txt"));
  const auto at_start = Answers(used);
  EXPECT_EQ(Difference(used, fresh), "");
  std::vector<std::string> slots = SlotsOf(used);
  // The window keeps its size while a film is recorded.
  std::erase(slots, "Record");
  slots.push_back("Record");
  for (const std::string& slot : slots) {
    if (slot == "Run" || Is(used, slot, "ReadOnly")) continue;
    const std::string value = Another(slot, files, onlooker);
    ASSERT_NE(value, "") << "this test has no value for " << slot;
    const std::string said = used.Say("set#1 " + slot + " = " + value);
    EXPECT_EQ(said.find(".error"), std::string::npos) << said;
    if (!Is(used, slot, "WriteOnly")) {
      EXPECT_NE(used.Say("inq " + slot), at_start.at(slot)) << slot;
    }
  }
  used.Say("set Nothing = 1");
  EXPECT_NE(used.Say("inq Error"), at_start.at("Error"));
  used.Say("def FaceExp.SMIRK = 12R 1");
  used.Say("def FaceExp.HAPPY.6 = 12 1");
  used.Say("prop Frame = AutoOutput");
  used.Until(1500);
  used.Say("prop Frame = NoAutoOutput");
  EXPECT_EQ(used.Say("inq Speak.stat"), "rep Speak.stat = SPEAKING");

  used.Say("set Run = INIT");
  fresh.Until(1500);
  EXPECT_EQ(Difference(used, fresh), "");
  EXPECT_EQ(used.world.face, fresh.world.face);
  EXPECT_EQ(used.world.width(), fresh.world.width());
  EXPECT_EQ(used.world.height(), fresh.world.height());
  EXPECT_FALSE(used.module.Busy());
  EXPECT_FALSE(used.clock.Next().has_value()) << "something is still to come";
  EXPECT_EQ(Performance(used), Performance(fresh));
  EXPECT_EQ(used.Say("set#1 FaceExp = SMIRK 1 100 0"), fresh.Say("set#1 FaceExp = SMIRK 1 100 0"));
  EXPECT_EQ(Difference(used, fresh), "");
}

TEST(InitTest, TheNextFilmHasNotTheSoundOfTheOneBefore) {
  FsmStage fsm;
  fsm.Say("set Record.sound = old.wav");
  fsm.Say("set Run = INIT");
  fsm.Say("set Record = next.mp4");
  fsm.Until(500);
  fsm.Say("set Record = STOP");
  EXPECT_EQ(fsm.world.films["next.mp4"].sound, "");
}

TEST(InitTest, AFilmEndsWithWhatWasSaidBefore) {
  FsmStage fsm;
  fsm.Say("set Record.sound = voice.wav");
  fsm.Say("set Record = film.mp4");
  fsm.Say("set LipSync.pho = a 2000");
  fsm.Say("set Speak = NOW");
  fsm.Until(990);
  fsm.Say("set Run = INIT");
  const auto& film = fsm.world.films["film.mp4"];
  EXPECT_TRUE(film.finished);
  EXPECT_EQ(film.sound, "voice.wav");
  ASSERT_EQ(film.jaws.size(), 30U);  // 30 a second, up to now
  EXPECT_GT(film.jaws.back(), 3);
  EXPECT_EQ(fsm.Say("inq Record"), "rep Record = STOP");
  EXPECT_EQ(fsm.Say("set#1 Window = 100 100"), "rep#1 Window = 100 100");
}

TEST(InitTest, AFilmHasTheRateOfTheStartAgain) {
  FsmStage fsm;
  const auto frames = [&fsm](const char* film, double until_ms) {
    fsm.Say(std::string("set Record = ") + film);
    fsm.Until(until_ms);
    fsm.Say("set Record = STOP");
    return fsm.world.films[film].jaws.size();
  };
  fsm.Say("set Record.fps = 10");
  EXPECT_EQ(frames("slow.mp4", 990), 10U);
  fsm.Say("set Run = INIT");
  EXPECT_EQ(frames("usual.mp4", 990 + 990), 30U);
}

TEST(InitTest, AWindowHasItsSizeAgainAndFillsTheScreenNoMore) {
  FsmStage fsm({}, true);
  fsm.Say("set Window = 320 240");
  fsm.Say("set Window = FULLSCREEN");
  ASSERT_TRUE(fsm.world.fills_screen);
  fsm.Say("set Run = INIT");
  EXPECT_FALSE(fsm.world.fills_screen);
  EXPECT_EQ(fsm.world.width(), 640);
  EXPECT_EQ(fsm.Say("inq Window"), "rep Window = 640 480");
}

TEST(InitTest, WhatTheCommandLineAndTheConfigurationSayHoldsAgain) {
  FsmOptions options;
  options.initial_face = "pygmalion";
  options.life = "CALM";
  options.config.language = Language::kEnglish;
  options.config.expression_ms = 700;
  options.config.backgrounds = {{"bg1", "there.png"}};
  FsmStage used(options), fresh(options);
  for (const char* line : {"set Life = OFF", "set Mask = galatea", "set Background = #ff0000",
                           "set LipSync.language = JP", "set FaceExp.onset = POSED"}) {
    used.Say(line);
  }
  used.Say("set Run = INIT");
  EXPECT_EQ(Difference(used, fresh), "");
  EXPECT_EQ(used.Say("inq Life"), "rep Life = CALM");
  EXPECT_EQ(used.world.face, "pygmalion");
  EXPECT_TRUE(used.module.motion().NextMotion(FromMs(5000)).has_value()) << "it lives";
}

TEST(InitTest, AConfiguredBackgroundThatIsGoneLeavesThePlainOne) {
  FsmOptions options;
  options.config.backgrounds = {{"bg1", "missing.png"}};
  ::testing::internal::CaptureStderr();
  FsmStage used(options), fresh(options);
  ::testing::internal::GetCapturedStderr();
  used.Say("set Background = transparent");
  used.Say("set Run = INIT");
  EXPECT_EQ(used.Say("inq Error"), "rep Error = UNAVAILABLE cannot read missing.png");
  fresh.Say("set Background = missing.png");  // gives the same error
  EXPECT_EQ(Difference(used, fresh), "");
  EXPECT_EQ(used.Say("inq Background"), "rep Background = plain");
}

TEST(InitTest, AFaceThatIsGoneLeavesTheOneWorn) {
  FsmStage fsm, worn;
  for (FsmStage* each : {&fsm, &worn}) each->Say("set Mask = pygmalion");
  fsm.world.gone = "galatea";
  fsm.Say("set Run = INIT");
  EXPECT_EQ(fsm.Say("inq Error"), "rep Error = UNAVAILABLE galatea cannot be made");
  EXPECT_EQ(fsm.Say("inq NowMask"), "rep NowMask = \"pygmalion\"");
  EXPECT_EQ(fsm.Say("inq Mask"), "rep Mask = pygmalion");
  EXPECT_EQ(Performance(fsm), Performance(worn))
      << "the sides are as unlike as the face worn has it";
}

TEST(InitTest, FramesAreCountedFromTheStart) {
  FsmStage fsm;
  fsm.Say("prop Frame = AutoOutput");
  fsm.Say("set FaceMot = NOD 1");
  fsm.Until(1000);
  fsm.Say("set Run = INIT");
  EXPECT_EQ(fsm.Say("inq Frame"), "rep Frame = ");
  fsm.Say("set FaceMot = NOD 1");
  const std::string said = fsm.Until(2000);
  EXPECT_TRUE(said.starts_with("rep Frame = 0 ")) << said;
}

TEST(FrameTest, AHeadThatCannotBeMadeIsOneErrorAndAllElseGoesOn) {
  FsmStage fsm;
  fsm.world.no_head = "cannot measure: there is no such file";
  fsm.Say("prop Frame = AutoOutput");
  fsm.Say("set FaceMot = NOD 1");
  EXPECT_EQ(fsm.Until(1000).find("rep Frame"), std::string::npos);
  EXPECT_EQ(fsm.errors, std::vector<std::string>{"UNAVAILABLE " + fsm.world.no_head});
  EXPECT_EQ(fsm.Say("inq Mask"), "rep Mask = galatea");
  fsm.world.no_head.clear();
  fsm.Say("set Mask = pygmalion");
  fsm.Say("set FaceMot = NOD 1");
  EXPECT_NE(fsm.Until(2000).find("rep Frame"), std::string::npos) << "another head is measured";
}

TEST(InitTest, OwnExpressionsCanBeMadeAgain) {
  FsmStage fsm;
  for (int round = 0; round < 3; ++round) {
    for (int k = 0; k < 150; ++k) {
      const std::string name = "FaceExp.R" + std::to_string(round) + "X" + std::to_string(k);
      EXPECT_EQ(fsm.Say("def#1 " + name + " = 12 1").find(".error"), std::string::npos) << name;
    }
    fsm.Say("set Run = INIT");
    EXPECT_NE(fsm.Say("inq#1 FaceExp.R0X0.1").find("UNKNOWN_SLOT"), std::string::npos);
  }
}

}  // namespace
}  // namespace fsm
