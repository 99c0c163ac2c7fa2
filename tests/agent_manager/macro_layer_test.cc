#include "agent_manager/macros/macro_layer.h"

#include <gtest/gtest.h>

#include "agent_manager/macros/speak.h"
#include "tests/agent_manager/world.h"

namespace am {
namespace {

using std::chrono::milliseconds;
using Strings = std::vector<std::string>;

/// A voice and a face in memory that keep the original's order of reports.
class MacroLayerTest : public testing::Test {
 protected:
  MacroLayerTest()
      : mcl_(
            world_.clock, world_.hub,
            [this](const std::string& path) -> vm::Result<std::string> {
              if (files_.contains(path)) return files_[path];
              return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "'");
            },
            [this](const std::string& path) { removed_.push_back(path); }) {
    world_.Connect(mcl_, {"FS-MCL"});
    mcl_.AddReader("emotion", ReadEmotion);
    auto built_in = ParseMacroFile(BuiltInMacros());
    EXPECT_TRUE(built_in) << built_in.error().text;
    for (vm::SlotSpec& slot : built_in->slots) mcl_.Declare(std::move(slot));
    for (Macro& macro : built_in->macros) EXPECT_TRUE(mcl_.Define(std::move(macro)));
    client_ = world_.Join(PeerKind::kClient, "A");
  }

  void JoinVoice() {
    voice_ = world_.JoinModern(
        "SSM", vm::Time(0), [this](World::Peer& self, const vm::Message& message) {
          if (message.slot == "Text" && voice_prepares_) {
            for (const auto* line : {"rep Speak.stat = PROCESSING", "rep Text.pho = p[100] a[900]",
                                     "rep Speak.stat = READY"})
              world_.Say(self, line);
          }
          if (message.slot != "Speak") return;
          started_ = message.value;
          world_.clock.Cancel(timer_);
          if (message.value == "STOP") {
            for (const auto* line :
                 {"rep Speak.len = 400", "rep Speak.utt = p[100] a[300]", "rep Speak.stat = IDLE"})
              world_.Say(self, line);
            return;
          }
          const vm::Time at = *vm::ParseMs(message.value.substr(1));
          timer_ = world_.clock.At(at, [this, &self, at] {
            world_.Say(self, "rep Speak.stat = SPEAKING");
            timer_ = world_.clock.At(at + milliseconds(500), [this, &self, at] {
              world_.Say(self, "tell Speak.sync = 500");
              timer_ = world_.clock.At(at + milliseconds(1000), [this, &self] {
                for (const auto* line : {"rep Speak.len = 1000", "rep Speak.utt = p[100] a[900]",
                                         "rep Speak.stat = IDLE"})
                  world_.Say(self, line);
              });
            });
          });
        });
  }
  void JoinFace() {
    face_ = world_.JoinModern(
        "FSM", vm::Time(0), [this](World::Peer& self, const vm::Message& message) {
          if (message.slot == "LipSync.pho" && face_prepares_)
            world_.Say(self, "rep Speak.stat = READY");
          if (message.slot != "Speak") return;
          if (message.value == "STOP") return world_.Say(self, "rep Speak.stat = IDLE");
          face_started_ = message.value;
          world_.clock.At(*vm::ParseMs(message.value.substr(1)) + milliseconds(1000),
                          [this, &self] { world_.Say(self, "rep Speak.stat = IDLE"); });
        });
  }
  Strings Run(milliseconds limit = milliseconds(100000)) {
    world_.clock.RunUntilIdle(world_.clock.Now() + limit);
    return client_->heard;
  }
  static bool Contains(const Strings& lines, const std::string& part) {
    return std::ranges::any_of(
        lines, [&](const std::string& line) { return line.find(part) != std::string::npos; });
  }

  World world_;
  Strings removed_;
  std::map<std::string, std::string> files_;
  MacroLayer mcl_;
  std::shared_ptr<World::Peer> client_, voice_, face_;
  std::string started_, face_started_;
  vm::TimerId timer_ = 0;
  bool voice_prepares_ = true, face_prepares_ = true;
};

TEST_F(MacroLayerTest, SpeakingPreparesBothStartsBothAtOneInstantAndFollowsTheVoice) {
  JoinVoice();
  JoinFace();
  world_.Say(*client_, "to @AM-MCL set#1 Speak = pa");
  EXPECT_EQ(Run(), Strings{"From @AM-MCL rep#1 Speak = pa"});
  EXPECT_FALSE(started_.empty());
  EXPECT_EQ(started_, face_started_);
  EXPECT_TRUE(Contains(face_->heard, "LipSync.pho = p 100 a 900"));
  EXPECT_TRUE(Contains(face_->heard, "Speak.sync = 500"));
  EXPECT_EQ(mcl_.slots().Value("Speak.len"), "1000");
  EXPECT_FALSE(mcl_.Busy());
}

TEST_F(MacroLayerTest, AModuleIsAskedOnceToReportWhatMacrosWaitFor) {
  const auto arm = world_.JoinModern("ARM");
  world_.Say(*client_, "to @AM-MCL def W = [{\"wait\": {\"from\": \"ARM\", \"slot\": \"A\"}}]");
  Run();
  EXPECT_EQ(std::ranges::count_if(arm->heard, [](const auto& l) { return l.starts_with("prop"); }),
            2)
      << "its errors and A";
  arm->heard.clear();
  for (int i = 0; i < 3; ++i)
    world_.Say(*client_, "to @AM-MCL def Z" + std::to_string(i) + " = []");
  Run();
  EXPECT_EQ(arm->heard, Strings{});
}

TEST_F(MacroLayerTest, WhatMacrosWaitForIsBounded) {
  std::string waits;
  std::string answer;
  for (std::size_t i = 0; i < MacroLayer::kMaxAwaited + 500 && answer.empty(); ++i) {
    waits += (waits.empty() ? "" : ", ") +
             std::string("{\"wait\": {\"from\": \"ARM\", \"slot\": \"A") + std::to_string(i) +
             "\"}}";
    if (i % 500 != 499) continue;
    client_->heard.clear();
    world_.Say(*client_, "to @AM-MCL def#1 W" + std::to_string(i) + " = [" + waits + "]");
    Run();
    waits.clear();
    if (Contains(client_->heard, "LIMIT")) answer = client_->heard.back();
  }
  EXPECT_NE(answer.find("LIMIT macros wait for more than 8192 slots and events"),
            std::string::npos);
}

TEST_F(MacroLayerTest, AFloodOfToldEventsEndsTheMacroThatPassesThemOn) {
  const auto arm = world_.JoinModern("ARM");
  std::string steps;
  for (int i = 0; i < 200; ++i)
    steps +=
        "{\"follow\": {\"from\": \"ARM\", \"tell\": \"a\", \"send\": \"to @ARM set X = "
        "${told}\"}}, ";
  world_.Say(*client_,
             "to @AM-MCL def F = [" + steps +
                 "{\"wait\": {\"from\": \"ARM\", \"slot\": \"Never\"}, \"limit_ms\": 60000}]");
  world_.Say(*client_, "to @AM-MCL set#1 F = 1");
  world_.clock.RunReady();
  for (int i = 0; i < 4000; ++i) world_.hub.Receive(arm->key, std::string_view("tell a = 1"));
  Run();
  EXPECT_TRUE(Contains(client_->heard, "rep#1 F.error = LIMIT macros and scripts say more"))
      << client_->heard.back();
  EXPECT_LE(std::ranges::count(arm->heard, "set X = 1"), long{Sequence::kMaxSaid} + 1);
}

TEST_F(MacroLayerTest, WithoutAFaceItStillSpeaksAndWithoutAVoiceItSaysSo) {
  world_.Say(*client_, "to @AM-MCL set#1 Speak = pa");
  EXPECT_EQ(Run(),
            Strings{"From @AM-MCL rep#1 Speak.error = UNAVAILABLE the voice @SSM is not there"});
  JoinVoice();
  world_.Say(*client_, "to @AM-MCL set#2 Speak = pa");
  EXPECT_EQ(Run().back(), "From @AM-MCL rep#2 Speak = pa");
}

TEST_F(MacroLayerTest, AStopEndsItWithWhatWasSpokenAndTheNextSpeakWorks) {
  JoinVoice();
  JoinFace();
  world_.Say(*client_, "to @AM-MCL set#1 Speak = pa");
  world_.clock.RunUntil(world_.clock.Now() + milliseconds(400));
  world_.Say(*client_, "to @AM-MCL set#2 Speak = STOP");
  const Strings heard = Run();
  EXPECT_EQ(heard, (Strings{"From @AM-MCL rep#2 Speak = STOP",
                            "From @AM-MCL rep#1 Speak.error = STOPPED stopped on request after 400 "
                            "ms: p[100] a[300]"}));
  world_.Say(*client_, "to @AM-MCL set#3 Speak = pa");
  EXPECT_EQ(Run().back(), "From @AM-MCL rep#3 Speak = pa");
}

TEST_F(MacroLayerTest, ANewTextTakesThePlaceOfTheOneBeingSpoken) {
  JoinVoice();
  JoinFace();
  world_.Say(*client_, "to @AM-MCL set#1 Speak = pa");
  world_.clock.RunUntil(world_.clock.Now() + milliseconds(400));
  world_.Say(*client_, "to @AM-MCL set#2 Speak = papa");
  world_.Say(*client_, "to @AM-MCL set#3 Speak = mama");
  const Strings heard = Run();
  EXPECT_TRUE(Contains(heard, "rep#1 Speak.error = STOPPED a new Speak took its place"));
  EXPECT_TRUE(
      Contains(heard, "rep#2 Speak.error = STOPPED a newer Speak took its place before it began"));
  EXPECT_EQ(heard.back(), "From @AM-MCL rep#3 Speak = mama");
}

TEST_F(MacroLayerTest, AVoiceThatNeverPreparesEndsInOneReportInTime) {
  JoinVoice();
  JoinFace();
  voice_prepares_ = false;
  world_.Say(*client_, "to @AM-MCL set#1 Speak = pa");
  const Strings heard = Run();
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(
      heard[0],
      "From @AM-MCL rep#1 Speak.error = TIMEOUT @SSM did not report Text.pho within 10000 ms");
  voice_prepares_ = true;
  world_.Say(*client_, "to @AM-MCL set#2 Speak = pa");
  EXPECT_EQ(Run().back(), "From @AM-MCL rep#2 Speak = pa");
}

TEST_F(MacroLayerTest, AFaceThatNeverGetsReadyEndsInOneReportInTime) {
  JoinVoice();
  JoinFace();
  face_prepares_ = false;
  world_.Say(*client_, "to @AM-MCL set#1 Speak = pa");
  EXPECT_EQ(Run(), Strings{"From @AM-MCL rep#1 Speak.error = TIMEOUT @FSM did not report "
                           "Speak.stat = READY within 5000 ms"});
}

TEST_F(MacroLayerTest, AModuleThatDiesHalfWayIsNamedAndTheOtherIsStopped) {
  JoinVoice();
  JoinFace();
  world_.Say(*client_, "to @AM-MCL set#1 Speak = pa");
  world_.clock.RunUntil(world_.clock.Now() + milliseconds(400));
  world_.Leave(*face_, "killed by signal 9");
  const Strings heard = Run();
  EXPECT_EQ(heard, Strings{"From @AM-MCL rep#1 Speak.error = UNAVAILABLE @FSM has gone in the "
                           "middle of it (killed by signal 9)"});
  EXPECT_EQ(started_, "STOP");
}

TEST_F(MacroLayerTest, ASilentModuleIsATimeoutAndNotAHang) {
  JoinVoice();
  world_.answers = false;
  voice_prepares_ = false;
  world_.Say(*client_, "to @AM-MCL set#1 Speak = pa");
  EXPECT_EQ(
      Run(),
      Strings{"From @AM-MCL rep#1 Speak.error = TIMEOUT @SSM Text: no answer within 10000 ms"});
}

TEST_F(MacroLayerTest, TheOriginalsLinesReachTheFace) {
  JoinFace();
  world_.Say(*client_, "to @AM-MCL set Emotion = HAPPY");
  world_.Say(*client_, "to @FS-MCL set Emotion = FEARED 30");
  world_.Say(*client_, "to @AM-MCL set Mask = woman01 HAPPY 100 0 0 0");
  world_.Say(*client_, "to @FS-MCL set Rot = -2 -1 0");
  Run();
  for (const auto* part : {"FaceExp = HAPPY 1 100 0", "FaceExp = FEARED 1 30 0", "Mask = woman01",
                           "HeadRotAbs.1 = 0 0 0", "HeadRotAbs.1 = -2 -1 0"}) {
    EXPECT_TRUE(Contains(face_->heard, part)) << part;
  }
}

TEST_F(MacroLayerTest, AnEmotionAroundTheTextLastsAsLongAsTheSpeech) {
  JoinVoice();
  JoinFace();
  world_.Say(*client_, "to @AM-MCL set#1 Speak = <emotion type=\"SAD\" value=\"40\">pa</emotion>");
  Run();
  EXPECT_TRUE(Contains(face_->heard, "FaceExp = SAD 1 40 0"));
  EXPECT_TRUE(Contains(face_->heard, "FaceExp = NEUTRAL"));
  EXPECT_TRUE(Contains(voice_->heard, "Text = pa"));
}

TEST_F(MacroLayerTest, AfterAnEmotionAroundTheTextTheOneSetBeforeComesBack) {
  JoinVoice();
  JoinFace();
  world_.Say(*client_, "to @AM-MCL set Emotion = HAPPY 60");
  Run();
  world_.Say(*client_, "to @AM-MCL set#1 Speak = <emotion type=\"SAD\" value=\"40\">pa</emotion>");
  Run();
  const auto last = [this] {
    std::string found;
    for (const std::string& line : face_->heard) {
      if (line.find("FaceExp = ") != std::string::npos) found = line;
    }
    return found.substr(found.find("FaceExp = "));
  };
  EXPECT_EQ(last(), "FaceExp = HAPPY 1 60 0");
  world_.Say(*client_, "to @AM-MCL set Emotion = NEUTRAL");
  Run();
  world_.Say(*client_, "to @AM-MCL set#2 Speak = <emotion type=\"SAD\" value=\"40\">pa</emotion>");
  Run();
  EXPECT_EQ(last(), "FaceExp = NEUTRAL");
}

TEST_F(MacroLayerTest, WhatItWaitsForIsSwitchedOnAndEventsAreNot) {
  JoinVoice();
  Run();
  EXPECT_TRUE(Contains(voice_->heard, "Speak.stat = AutoOutput"));
  EXPECT_FALSE(Contains(voice_->heard, "Speak.sync = AutoOutput")) << "it is no slot";
}

TEST_F(MacroLayerTest, UsersDefineTheirOwnMacros) {
  JoinFace();
  world_.Say(
      *client_,
      R"(to @AM-MCL def#1 Greet = [{"send": "to @FSM set FaceMot = NOD 1"}, {"pause_ms": 250}, {"send": "to @FSM set FaceExp = ${1} 1 100 0"}])");
  world_.Say(*client_, "to @AM-MCL set#2 Greet = HAPPY");
  world_.Say(*client_, "to @AM-MCL def Wave << to @FSM set FaceMot = REFUSE 1");
  world_.Say(*client_, "to @AM-MCL do#3 Wave");
  const Strings heard = Run();
  EXPECT_TRUE(Contains(heard, "rep#1 Greet = defined"));
  EXPECT_TRUE(Contains(heard, "rep#2 Greet = HAPPY"));
  EXPECT_TRUE(Contains(heard, "rep#3 Wave"));
  EXPECT_TRUE(Contains(face_->heard, "FaceExp = HAPPY 1 100 0"));
  EXPECT_TRUE(Contains(face_->heard, "FaceMot = REFUSE 1"));
  world_.Say(*client_, "to @AM-MCL def#4 Bad = [{\"jump\": 1}]");
  EXPECT_TRUE(Contains(Run(), "rep#4 Bad.error = BAD_VALUE Bad[0].jump: unknown key"));
}

TEST_F(MacroLayerTest, RecordingStartsAndEndsInBothModules) {
  JoinVoice();
  JoinFace();
  world_.Say(*client_, "to @AM-MCL set#1 Record = /tmp/film.mp4");
  Run();
  world_.Say(*client_, "to @AM-MCL set#2 Record = STOP");
  const Strings heard = Run();
  EXPECT_TRUE(Contains(heard, "rep#2 Record = STOP"));
  EXPECT_TRUE(Contains(voice_->heard, "Record = /tmp/film.mp4.wav"));
  EXPECT_TRUE(Contains(face_->heard, "Record.sound = /tmp/film.mp4.wav"));
  EXPECT_EQ(removed_, Strings{"/tmp/film.mp4.wav"});
}

}  // namespace
}  // namespace am
