#include "agent_manager/routing/hub.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/agent_manager/world.h"

namespace am {
namespace {

using std::chrono::milliseconds;
using Strings = std::vector<std::string>;

TEST(HubTest, CommandsArriveBareAndReportsWithTheirSender) {
  World world;
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto b = world.Join(PeerKind::kClient, "B");
  world.Say(*a, "to @B set X = 1");
  EXPECT_EQ(b->heard, Strings{"set X = 1"});
  world.Say(*b, "to @A rep X = 1");
  EXPECT_EQ(a->heard, Strings{"From @B rep X = 1"});
  world.Say(*b, "From @FORGED to @A tell hello");
  EXPECT_EQ(a->heard.back(), "From @B tell hello") << "a sender cannot be forged";
}

TEST(HubTest, SeveralReceiversEachGetIt) {
  World world;
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto b = world.Join(PeerKind::kClient, "B");
  const auto c = world.Join(PeerKind::kClient, "C");
  world.Say(*a, "to @B,@C set Speak = STOP");
  EXPECT_EQ(b->heard, Strings{"set Speak = STOP"});
  EXPECT_EQ(c->heard, Strings{"set Speak = STOP"});
}

TEST(HubTest, WhatManyHearStandsOnceInTheLog) {
  std::vector<std::string> lines;
  vm::VirtualScheduler clock;
  SessionLog log([&](std::string_view line) { lines.emplace_back(line); });
  Hub hub(clock, log);
  vm::SlotMachine machine("AM");
  hub.AddMachine(machine);
  struct Nowhere final : Link {
    void Send(const Outgoing&) override {}
    void Close() override {}
  };
  for (const char* name : {"A", "B"}) {
    const auto key = hub.Attach(std::make_unique<Nowhere>(), PeerKind::kClient, Role::kOwner, name,
                                Dialect::kAuto);
    ASSERT_TRUE(key);
    hub.Subscribe(*key, {"*"});
  }
  machine.TellAll("hello");
  EXPECT_EQ(std::ranges::count_if(lines, [](const auto& l) { return l.ends_with("tell hello"); }),
            1);
  EXPECT_TRUE(lines.back().ends_with("AM\tA,B\tFrom @AM tell hello")) << lines.back();
}

TEST(HubTest, WhoeverAskedIsAnsweredAlsoWhereTheAnsweringThrows) {
  World world;
  vm::SlotMachine machine("AM");
  world.hub.AddMachine(machine);
  world.hub.router().set_on_machine(
      [](vm::SlotMachine&, const Envelope&) -> vm::Result<Router::Taken> {
        throw std::runtime_error("thrown");
      });
  const std::string why = " = INTERNAL a message could not be dealt with: thrown";
  const auto client = world.Join(PeerKind::kClient, "A");
  world.Say(*client, "set#1 X = 1");
  EXPECT_EQ(client->heard, Strings{"From @AM rep#1 X.error" + why});
  world.Say(*client, "set X = 1");
  EXPECT_EQ(client->heard.back(), "From @AM rep Error" + why);
  const auto module = world.Join(PeerKind::kModule, "M", Dialect::kOriginal);
  world.Say(*module, "set#2 X = 1");
  EXPECT_EQ(module->heard, Strings{"From @AM rep#2 X.error" + why});
  int answers = 0;
  world.hub.Ask("AM", vm::To("AM", vm::Inq("X")), [&](const vm::Result<std::string>& answer) {
    ++answers;
    ASSERT_FALSE(answer);
    EXPECT_EQ(answer.error().code, vm::Errc::kInternal);
  });
  world.clock.Settle();
  EXPECT_EQ(answers, 1);
}

TEST(HubTest, AnUnknownReceiverIsAnsweredWithAnError) {
  World world;
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @NOBODY set#7 X = 1");
  world.Say(*a, "to @NOBODY set X = 1");
  EXPECT_EQ(
      a->heard,
      (Strings{
          "From @AM rep#7 X.error = UNKNOWN_MODULE there is no @NOBODY (inq Modules lists them)",
          "From @AM rep X.error = UNKNOWN_MODULE there is no @NOBODY (inq Modules lists them)"}));
}

TEST(HubTest, ReportsWithoutReceiverGoToThoseWhoSubscribedAndToTheBroadcastList) {
  World world;
  const auto m = world.JoinModern("SSM");
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto dm = world.Join(PeerKind::kClient, "DM");
  const auto other = world.Join(PeerKind::kClient, "OTHER");
  world.hub.router().set_broadcast({"DM"});
  world.hub.Subscribe(a->key, {"SSM"});
  world.Say(*m, "rep Speak.stat = IDLE");
  EXPECT_EQ(a->heard, Strings{"From @SSM rep Speak.stat = IDLE"});
  EXPECT_EQ(dm->heard, Strings{"From @SSM rep Speak.stat = IDLE"});
  EXPECT_EQ(other->heard, Strings{});
}

TEST(HubTest, ATagComesBackToTheAskerOnlyAndAnUntaggedQuestionToo) {
  World world;
  const auto m = world.JoinModern("SSM", vm::Time(0));
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto b = world.Join(PeerKind::kConsole, "CONSOLE");
  world.Say(*a, "to @SSM set#x1 Volume = 5");
  world.Say(*a, "to @SSM inq Speaker");
  world.clock.RunReady();
  EXPECT_EQ(a->heard, (Strings{"From @SSM rep#x1 Volume = 5", "From @SSM rep Speaker = "}));
  EXPECT_EQ(b->heard, Strings{});
  EXPECT_EQ(world.hub.clocks().WithClock().size(), 1u);
}

TEST(HubTest, RefusalsKeepTheirCodeWithAndWithoutATag) {
  World world;
  world.answers = false;
  const auto refusing = [&](World::Peer& self, const vm::Message& message) {
    if (message.slot == "Clock") return world.Say(self, "rep#" + message.tag + " Clock = 5");
    world.Say(self, "rep#" + message.tag + " " + message.slot + ".error = BUSY not now");
  };
  world.JoinModern("SSM", vm::Time(0), refusing);
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @SSM set#1 Text = x");
  world.Say(*a, "to @SSM set Text = x");
  world.clock.RunReady();
  EXPECT_EQ(a->heard, (Strings{"From @SSM rep#1 Text.error = BUSY not now",
                               "From @SSM rep Text.error = BUSY not now"}));
}

TEST(HubTest, NamesCannotBeTakenTwice) {
  World world;
  const auto a = world.Join(PeerKind::kClient, "A");
  EXPECT_EQ(world.Join(PeerKind::kClient, "A")->key, 0u);
  const auto b = world.Join(PeerKind::kClient, "B");
  EXPECT_FALSE(world.hub.Rename(b->key, "A"));
  EXPECT_TRUE(world.hub.Rename(b->key, "C"));
  world.Say(*a, "to @C set X = 1");
  EXPECT_EQ(b->heard, Strings{"set X = 1"});
  world.Leave(*a, "gone");
  EXPECT_TRUE(world.hub.Rename(b->key, "A")) << "a name is free when its holder has gone";
}

TEST(HubTest, WhoHasTheNameOfANewModuleGetsAnotherOne) {
  World world;
  const auto guest = world.JoinAs(Role::kGuest, "ROBOT");
  const auto bridge = world.Join(PeerKind::kClient, "MQTT");
  world.hub.Reserve({"ROBOT", "ARM", "MQTT"});
  world.clock.Settle();
  EXPECT_TRUE(world.hub.directory().IsPresent("MQTT")) << "one of the hub's own parts";
  EXPECT_FALSE(world.hub.directory().IsPresent("ROBOT"));
  ASSERT_FALSE(guest->heard.empty());
  EXPECT_NE(guest->heard.back().find("rep Error = BUSY the name @ROBOT is that of a module now"),
            std::string::npos)
      << guest->heard.back();
  EXPECT_FALSE(world.hub.Rename(guest->key, "ROBOT"));
  const auto module = world.JoinModern("ROBOT");
  EXPECT_TRUE(world.hub.directory().IsModule("ROBOT"));
}

TEST(HubTest, AModuleThatTakesAnotherNameGoesAndComes) {
  World world;
  Strings seen;
  world.hub.set_on_presence([&](const auto& name, bool present, const auto& reason) {
    seen.push_back(name + (present ? " comes" : " goes: " + reason));
  });
  const auto module = world.JoinAs(Role::kClient, "ARM");
  world.Say(*module, "rep Run = LIVE");
  world.hub.clocks().EndProbes(world.hub.clocks().Probing());
  world.clock.RunReady();
  seen.clear();
  EXPECT_TRUE(world.hub.Rename(module->key, "ARM2"));
  world.clock.RunReady();
  EXPECT_EQ(seen, (Strings{"ARM goes: it is called @ARM2 now", "ARM2 comes"}));
}

TEST(HubTest, TheDeathOfAModuleAnswersWhatWasAskedOfIt) {
  World world;
  const auto m = world.JoinModern("SSM");
  const auto a = world.Join(PeerKind::kClient, "A");
  world.answers = false;
  world.Say(*a, "to @SSM set#1 Text = x");
  world.Say(*a, "to @SSM inq Speaker");
  world.clock.RunReady();
  world.Leave(*m, "killed by signal 9");
  EXPECT_EQ(
      a->heard,
      (Strings{"From @SSM rep#1 Text.error = UNAVAILABLE @SSM has gone (killed by signal 9)",
               "From @SSM rep Speaker.error = UNAVAILABLE @SSM has gone (killed by signal 9)"}));
}

TEST(HubTest, ClockOffsetsAreMeasuredAndStartTimesTranslated) {
  World world;
  world.clock.RunUntil(milliseconds(1000));
  const auto m = world.JoinModern("SSM", milliseconds(250));
  const auto a = world.Join(PeerKind::kClient, "A");
  EXPECT_EQ(world.hub.clocks().ClockOf("SSM").offset, milliseconds(250));
  EXPECT_EQ(world.hub.clocks().ClockOf("SSM").delay, vm::Time(0));
  world.Say(*a, "to @SSM set Speak = @5000");
  ASSERT_FALSE(m->heard.empty());
  EXPECT_NE(m->heard.back().find("Speak = @5250"), std::string::npos) << m->heard.back();
}

TEST(HubTest, AModuleOfTheOriginalGetsBareLinesAndItsStartHeldBack) {
  World world;
  const auto m = world.Join(PeerKind::kModule, "SSM", Dialect::kOriginal);
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @SSM set#1 Text = x");
  EXPECT_EQ(a->heard, Strings{"From @SSM rep#1 Text = x"});
  world.Say(*a, "to @SSM set Speak = @300");
  EXPECT_EQ(m->heard, Strings{"set Text = x"});
  world.clock.RunUntil(milliseconds(300));
  EXPECT_EQ(m->heard, (Strings{"set Text = x", "set Speak = NOW"}));
  world.Say(*a, "to @SSM set Speak = @500");
  world.Say(*a, "to @SSM set Speak = STOP");
  world.clock.RunUntil(milliseconds(1000));
  EXPECT_EQ(m->heard.back(), "set Speak = STOP") << "a stop takes back the start that was held";
  world.Say(*a, "to @SSM inq#2 Speaker");
  world.Say(*m, "rep Speaker = male01");
  EXPECT_EQ(a->heard.back(), "From @SSM rep#2 Speaker = male01");
}

TEST(HubTest, WhatIsSaidToAModuleThatIsStillStartingWaitsInOrder) {
  World world;
  const auto m = world.Join(PeerKind::kModule, "SSM");
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @SSM set Text = one");
  world.Say(*a, "to @SSM set Speak = NOW");
  EXPECT_EQ(m->heard.size(), 1u) << "only the probe";
  world.hub.clocks().EndProbes(world.hub.clocks().Probing());
  EXPECT_EQ(m->heard.size(), 1u) << "it has not said a word: it may still be starting";
  world.Say(*m, "rep Run = LIVE");
  world.hub.clocks().EndProbes(world.hub.clocks().Probing());
  EXPECT_EQ(m->heard[1], "set Text = one");
  EXPECT_EQ(m->heard[2], "set Speak = NOW");
}

TEST(HubTest, AFloodOfBadLinesIsNotAFloodOfReports) {
  World world;
  const auto a = world.Join(PeerKind::kClient, "A");
  int notices = 0;
  world.hub.set_on_notice([&](const std::string&, PeerKey) { ++notices; });
  for (int i = 0; i < 10000; ++i) world.Say(*a, "nonsense");
  EXPECT_LE(notices, 10);
  EXPECT_LE(a->heard.size(), 10u);
}

TEST(HubTest, AModuleThatAnswersNothingIsBounded) {
  World world;
  world.JoinModern("SSM");
  world.answers = false;
  const auto a = world.Join(PeerKind::kClient, "A");
  for (std::size_t i = 0; i < world.hub.limits().pending + 100; ++i)
    world.Say(*a, "to @SSM set#t X = 1");
  EXPECT_GE(a->heard.size(), 100u);
  EXPECT_NE(a->heard.front().find("LIMIT"), std::string::npos);
}

TEST(HubTest, AFloodOfQuestionsIsReadSlowerAndCostsNobodyElseAnAnswer) {
  World world;
  world.JoinModern("SSM");
  world.answers = false;
  world.hub.set_limit(&Limits::pending, 100);
  const auto flood = world.Join(PeerKind::kClient, "FLOOD");
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @SSM inq#mine Run");
  for (int i = 0; i < 5000; ++i) world.Say(*flood, "to @SSM inq#x Volume");
  EXPECT_TRUE(flood->paused);
  EXPECT_FALSE(a->paused);
  EXPECT_EQ(a->heard, Strings{}) << "it goes on waiting";
  world.clock.RunUntil(world.clock.Now() + std::chrono::minutes(3));
  EXPECT_FALSE(flood->paused) << "its questions have been answered";
}

TEST(HubTest, WhatIsSaidToSomebodyWhoIsNotThereIsHeardByNobodyElse) {
  World world;
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto onlooker = world.Join(PeerKind::kConsole, "CONSOLE");
  world.Say(*a, "to @NOBODY tell a secret");
  EXPECT_EQ(onlooker->heard, Strings{});
  EXPECT_NE(a->heard.at(0).find("there is no @NOBODY"), std::string::npos);
}

TEST(HubTest, ARuleForOneOfTwoReceiversHoldsForThatOne) {
  World world;
  Rule rule;
  rule.to = {"B"};
  rule.drop = true;
  world.hub.router().set_rules({rule});
  const auto a = world.Join(PeerKind::kClient, "A"), b = world.Join(PeerKind::kClient, "B"),
             c = world.Join(PeerKind::kClient, "C");
  world.Say(*a, "to @B,@C tell hello");
  EXPECT_EQ(b->heard, Strings{});
  EXPECT_EQ(c->heard, Strings{"From @A tell hello"});
}

TEST(HubTest, TwoWhoAskEachOtherMuchBothGoOn) {
  World world;
  world.hub.set_limit(&Limits::pending, 100);
  const auto a = world.JoinModern("AA"), b = world.JoinModern("BB");
  world.answers = false;
  for (int i = 0; i < 90; ++i) {
    world.Say(*a, "to @BB inq#q" + std::to_string(i) + " X");
    world.Say(*b, "to @AA inq#q" + std::to_string(i) + " X");
  }
  EXPECT_FALSE(a->paused) << "the other one waits for its answers";
  EXPECT_FALSE(b->paused);
}

TEST(HubTest, WhoReportsWithoutPauseWaitsForThoseWhoHear) {
  World world;
  world.hub.set_limit(&Limits::backlog_bytes, 1000);
  const auto slow = world.Join(PeerKind::kConsole, "CONSOLE");
  const auto guest = world.JoinAs(Role::kGuest, "G");
  slow->backlog = 600;
  world.Say(*guest, "rep X = 1");
  EXPECT_TRUE(guest->paused);
  slow->backlog = 0;
  world.clock.RunUntil(world.clock.Now() + std::chrono::milliseconds(20));
  EXPECT_FALSE(guest->paused);
}

TEST(HubTest, NamesThatOthersHaveTakenKeepNobodyOut) {
  World world;
  const auto a = world.JoinAs(Role::kGuest, "");
  for (int i = 2; i < 9; ++i)
    EXPECT_TRUE(world.hub.Rename(world.JoinAs(Role::kGuest, "x" + std::to_string(i))->key,
                                 "CLIENT" + std::to_string(i)));
  const auto b = world.JoinAs(Role::kClient, "");
  EXPECT_EQ(world.hub.directory().NameOf(b->key), "CLIENT9");
}

TEST(HubTest, AllTogetherHaveALimitAndWhoeverHasMostLosesOne) {
  World world;
  world.JoinModern("SSM");
  world.answers = false;
  world.hub.set_limit(&Limits::pending, 10);
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @SSM inq#mine Run");
  std::vector<std::shared_ptr<World::Peer>> many;
  for (int i = 0; i < 40; ++i) {
    many.push_back(world.Join(PeerKind::kClient, "M" + std::to_string(i)));
    for (int k = 0; k < 10; ++k) world.Say(*many.back(), "to @SSM inq#x Volume");
  }
  EXPECT_EQ(a->heard, Strings{});
  EXPECT_LE(world.hub.Status()[0].pending, 160u);
}

TEST(HubTest, WhoSpeaksNoMoreLeavesWithItsAnswers) {
  World world;
  world.JoinModern("SSM");
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto b = world.Join(PeerKind::kClient, "B");
  world.answers = false;
  world.Say(*a, "to @SSM set#1 X = 1");
  world.hub.EndInput(a->key);
  world.hub.EndInput(b->key);
  world.clock.RunReady();
  EXPECT_TRUE(b->closed) << "it has asked nothing";
  EXPECT_FALSE(a->closed);
  world.clock.RunUntil(world.clock.Now() + std::chrono::minutes(3));
  EXPECT_NE(a->heard.back().find("rep#1 X.error = TIMEOUT"), std::string::npos);
  EXPECT_TRUE(a->closed);
}

TEST(HubTest, GuestsLeaveRoomForOthers) {
  World world;
  world.hub.set_limit(&Limits::peers, 16);
  std::vector<std::shared_ptr<World::Peer>> guests;
  for (int i = 0; i < 20; ++i) guests.push_back(world.JoinAs(Role::kGuest, ""));
  EXPECT_EQ(world.hub.Status().size(), 14u);
  EXPECT_TRUE(guests.back()->closed);
  EXPECT_NE(world.JoinAs(Role::kClient, "C")->key, kHub);
}

TEST(HubTest, AModuleOfTheOriginalThatAnswersNothingIsBoundedToo) {
  World world;
  const auto m = world.Join(PeerKind::kModule, "SSM", Dialect::kOriginal);
  const auto a = world.Join(PeerKind::kClient, "A");
  world.hub.set_limit(&Limits::pending, 10);
  for (int i = 0; i < 200; ++i)
    world.Say(*a, "to @SSM inq#" + std::to_string(i) + " S" + std::to_string(i));
  EXPECT_EQ(a->heard.size(), 190u);
  EXPECT_NE(a->heard.front().find("rep#0 S0.error = LIMIT"), std::string::npos);
  EXPECT_EQ(world.hub.Status()[0].pending, 10u);
  world.clock.RunUntil(world.clock.Now() + std::chrono::minutes(3));
  EXPECT_EQ(a->heard.size(), 200u) << "one time-out for both dialects";
  EXPECT_EQ(world.hub.Status()[0].pending, 0u);
}

TEST(HubTest, ATaggedLineThatIsNoMessageIsAnsweredWithItsTag) {
  World world;
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @B set#7 X");
  ASSERT_EQ(a->heard.size(), 1u);
  EXPECT_TRUE(a->heard[0].starts_with("From @AM rep#7 Error = SYNTAX")) << a->heard[0];
}

TEST(HubTest, WhatAConsumerThrowsIsThatPeersErrorAndNothingElse) {
  World world;
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto b = world.Join(PeerKind::kClient, "B");
  world.hub.router().set_on_report([](const std::string&, const vm::Message& message) {
    if (message.value == "boom") throw std::runtime_error("a consumer's fault");
  });
  world.Say(*a, "to @B rep X = boom");
  EXPECT_EQ(b->heard, Strings{"From @A rep X = boom"});
  ASSERT_EQ(a->heard.size(), 1u);
  EXPECT_NE(a->heard[0].find("INTERNAL"), std::string::npos) << a->heard[0];
  world.Say(*a, "to @B rep X = fine");
  EXPECT_EQ(b->heard.back(), "From @A rep X = fine");
}

TEST(HubTest, AConsumerThatSpeaksIsHeardAfterTheMessageItHeard) {
  World world;
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto b = world.Join(PeerKind::kClient, "B");
  const auto c = world.Join(PeerKind::kClient, "C");
  world.hub.router().set_on_report([&](const std::string&, const vm::Message&) {
    world.hub.Ask("AM", vm::To("C", vm::Set("Y", "1")), nullptr);
    world.hub.Leave(a->key, "in the middle of its own message");
  });
  world.Say(*a, "to @B,@C rep X = 1");
  EXPECT_EQ(b->heard, Strings{"From @A rep X = 1"});
  EXPECT_EQ(c->heard, (Strings{"From @A rep X = 1", "set Y = 1"}));
  EXPECT_TRUE(a->closed);
}

TEST(HubTest, TheHubIsFullAtItsLimit) {
  World world;
  for (std::size_t i = 0; i < world.hub.limits().peers; ++i)
    EXPECT_NE(world.Join(PeerKind::kClient, "")->key, 0u);
  const auto late = world.Join(PeerKind::kClient, "");
  EXPECT_EQ(late->key, 0u);
  EXPECT_TRUE(late->closed);
}

}  // namespace
}  // namespace am
