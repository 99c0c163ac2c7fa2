// The machines of the original that are parts of the hub: @PAR and @SND.

#include <gtest/gtest.h>

#include <filesystem>

#include "agent_manager/macros/parallel.h"
#include "agent_manager/macros/sound_player.h"
#include "tests/agent_manager/world.h"

namespace am {
namespace {

using Strings = std::vector<std::string>;

TEST(ParallelTest, ItsLinesBeginWithTheSpeechAndKeepTheirTimes) {
  World world;
  Parallel parallel(world.clock, world.hub);
  world.Connect(parallel, {}, true);
  const auto voice = world.Join(PeerKind::kModule, "SSM", Dialect::kOriginal);
  const auto face = world.Join(PeerKind::kModule, "FSM", Dialect::kOriginal);
  const auto a = world.Join(PeerKind::kClient, "A");
  for (const char* line : {"to @PAR set Init = 1", "to @PAR set Cmd = to @FSM set FaceMot = NOD 1",
                           "to @PAR set Cmd = sleep 0.5", "to @PAR set Cmd = to @FSM set X = 2"})
    world.Say(*a, line);
  EXPECT_EQ(face->heard, Strings{});
  world.Say(*voice, "rep Speak.stat = SPEAKING");
  EXPECT_EQ(face->heard, Strings{"set FaceMot = NOD 1"});
  world.clock.RunUntil(std::chrono::milliseconds(499));
  EXPECT_EQ(face->heard.size(), 1u);
  world.clock.RunUntil(std::chrono::milliseconds(500));
  EXPECT_EQ(face->heard.back(), "set X = 2");
  world.Say(*a, "to @PAR set#1 Cmd = sleep long");
  EXPECT_NE(a->heard.back().find("rep#1 Cmd.error = BAD_VALUE"), std::string::npos);
  const auto own = world.Join(PeerKind::kModule, "PAR", Dialect::kOriginal);
  world.Say(*a, "to @PAR set Cmd = mine");
  EXPECT_EQ(own->heard, Strings{"set Cmd = mine"}) << "a module of that name takes its place";
}

TEST(ParallelTest, EachPeerHasAListOfItsOwn) {
  World world;
  Parallel parallel(world.clock, world.hub);
  world.Connect(parallel, {}, true);
  const auto voice = world.Join(PeerKind::kModule, "SSM", Dialect::kOriginal);
  const auto face = world.Join(PeerKind::kModule, "FSM", Dialect::kOriginal);
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto guest = world.JoinAs(Role::kGuest, "GUEST");
  world.Say(*guest, "to @PAR set Cmd = sleep 60");
  world.Say(*a, "to @PAR set Cmd = to @FSM set X = 1");
  world.Say(*guest, "to @PAR set Init = 1");
  world.Say(*guest, "to @PAR set Cmd = sleep 60");
  world.Say(*voice, "rep Speak.stat = SPEAKING");
  EXPECT_EQ(face->heard, Strings{"set X = 1"}) << "nobody else's sleep or Init concerns it";
  world.Say(*a, "to @PAR set Cmd = to @FSM set X = 2");
  world.Say(*voice, "rep Speak.stat = SPEAKING");
  EXPECT_EQ(face->heard.back(), "set X = 2");
  EXPECT_TRUE(parallel.Busy());
}

TEST(ParallelTest, WhatOnePeerKeepsIsBounded) {
  World world;
  Parallel parallel(world.clock, world.hub);
  world.Connect(parallel, {}, true);
  const auto a = world.Join(PeerKind::kClient, "A");
  const std::string line = "to @PAR set#1 Cmd = to @FSM set X = " + std::string(20000, 'x');
  for (int i = 0; i < 4; ++i) world.Say(*a, line);
  EXPECT_NE(a->heard.back().find("Cmd.error = LIMIT"), std::string::npos);
  world.Leave(*a, "gone");
  const auto b = world.Join(PeerKind::kClient, "B");
  world.Say(*b, line);
  EXPECT_EQ(b->heard.back().find("error"), std::string::npos);
}

class SoundPlayerTest : public testing::Test {
 protected:
  SoundPlayerTest() {
    world_.Connect(player_, {}, true);
    voice_ = world_.JoinModern("SSM", vm::Time(0), [this](World::Peer&, const vm::Message& said) {
      if (said.command == vm::Command::kSet) set_.push_back(said.slot + " = " + said.value);
    });
    client_ = world_.JoinAs(Role::kOwner, "A");
    world_.hub.Subscribe(client_->key, {"SND"});
    world_.clock.RunReady();
    set_.clear();
  }
  void Say(const World::Peer& peer, const std::string& line) {
    world_.Say(peer, line);
    world_.clock.RunReady();
  }
  void VoiceIsIdle() { Say(*voice_, "rep Speak.stat = IDLE"); }

  World world_;
  SoundPlayer player_{world_.hub};
  std::shared_ptr<World::Peer> voice_, client_;
  Strings set_;
  /// Any file that is there.
  const std::string file_ = std::filesystem::read_symlink("/proc/self/exe");
};

TEST_F(SoundPlayerTest, TheVoicePlaysOneFileAfterTheOtherAndTheirBeginningAndEndAreTold) {
  Say(*client_, "to @SND set#1 Play = " + file_);
  Say(*client_, "to @SND set#2 Play = \"" + file_ + "\"");
  const std::string text = "Text = <speak><audio src=\"" + file_ + "\"/></speak>";
  EXPECT_EQ(set_, (Strings{text, "Speak = NOW"})) << "the second one waits";
  EXPECT_EQ(client_->heard,
            (Strings{"From @SND tell start " + file_, "From @SND rep#1 Play = " + file_}));
  EXPECT_TRUE(player_.Busy());
  VoiceIsIdle();
  EXPECT_EQ(set_, (Strings{text, "Speak = NOW", text, "Speak = NOW"}));
  VoiceIsIdle();
  EXPECT_EQ(client_->heard.back(), "From @SND tell end " + file_);
  EXPECT_EQ(client_->heard.size(), 6u);
  EXPECT_FALSE(player_.Busy());
  VoiceIsIdle();
  EXPECT_EQ(client_->heard.size(), 6u) << "what the voice says of its own speech is none of ours";
}

TEST_F(SoundPlayerTest, ASoundThatIsOverBeforeItsRequestIsDealtWithEnds) {
  world_.answers = false;
  Say(*client_, "to @SND set#1 Play = " + file_);
  const auto tag_of_last = [this] { return vm::TagOf(voice_->heard.back()); };
  Say(*voice_, "rep#" + tag_of_last() + " Text = x");
  const std::string speak = tag_of_last();
  for (const std::string line :
       {"rep Speak.stat = IDLE", "rep Speak.stat = SPEAKING", "rep Speak.stat = IDLE"}) {
    if (line.ends_with("SPEAKING"))
      world_.hub.Receive(voice_->key, std::string_view("rep#" + speak + " Speak = NOW"));
    world_.hub.Receive(voice_->key, std::string_view(line));
  }
  world_.clock.RunReady();
  EXPECT_EQ(client_->heard,
            (Strings{"From @SND tell start " + file_, "From @SND rep#1 Play = " + file_,
                     "From @SND tell end " + file_}));
  EXPECT_FALSE(player_.Busy());
}

TEST_F(SoundPlayerTest, StopEndsAllOfThemAndTheVoice) {
  Say(*client_, "to @SND set Play = " + file_);
  Say(*client_, "to @SND set#2 Play = " + file_);
  client_->heard.clear();
  Say(*client_, "to @SND set#3 Play = STOP");
  EXPECT_EQ(client_->heard,
            (Strings{"From @SND tell end " + file_,
                     "From @SND rep#2 Play.error = STOPPED set Play = STOP came first",
                     "From @SND rep#3 Play = STOP"}));
  EXPECT_EQ(set_.back(), "Speak = STOP");
  EXPECT_FALSE(player_.Busy());
}

TEST_F(SoundPlayerTest, WhatCannotBePlayedIsSaid) {
  Say(*client_, "to @SND set#1 Play = /no/such/file.wav");
  EXPECT_EQ(client_->heard.back(),
            "From @SND rep#1 Play.error = UNAVAILABLE there is no sound file '/no/such/file.wav'");
  Say(*client_, "to @SND set Play = " + file_);
  world_.Leave(*voice_, "it goes");
  world_.clock.RunReady();
  EXPECT_EQ(client_->heard.back(), "From @SND tell end " + file_);
  Say(*client_, "to @SND set#2 Play = " + file_);
  EXPECT_EQ(client_->heard.back(),
            "From @SND rep#2 Play.error = UNAVAILABLE there is no voice (@SSM) to play it");
}

TEST_F(SoundPlayerTest, TheVoicesRefusalIsTheAnswerAndTheNextFileGoesOn) {
  world_.answers = false;
  Say(*client_, "to @SND set#1 Play = " + file_);
  Say(*client_, "to @SND set#2 Play = " + file_);
  world_.answers = true;
  world_.clock.RunUntil(std::chrono::minutes(3));
  EXPECT_TRUE(std::ranges::any_of(client_->heard, [](const std::string& line) {
    return line.starts_with("From @SND rep#1 Play.error = TIMEOUT");
  }));
  EXPECT_TRUE(World::Heard(*client_, "From @SND rep#2 Play = " + file_));
}

}  // namespace
}  // namespace am
