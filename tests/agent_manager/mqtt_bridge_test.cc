// The bridge between the hub and a broker in memory.

#include <gtest/gtest.h>

#include "agent_manager/mqtt/bridge.h"
#include "tests/agent_manager/world.h"

namespace am::mqtt {
namespace {

using Strings = std::vector<std::string>;

/// Keeps what is published, and hands in what the test says came from elsewhere.
struct MemoryBroker final : Broker {
  int Publish(const Packet& packet) override {
    published.push_back(packet);
    return ++last;
  }
  void Subscribe(const std::string& filter, bool) override { filters.push_back(filter); }
  void Unsubscribe(const std::string& filter) override { std::erase(filters, filter); }
  void Rest(const std::string& reason) override { events.on_lost(reason); }
  std::vector<Packet> published;
  Strings filters;
  Events events;
  int last = 0;
};

struct BridgeTest : testing::Test {
  BridgeTest() { Start({}); }
  void Start(Strings modules) {
    bridge.reset();
    MqttConfig config;
    config.broker = "tcp:127.0.0.1:1883";
    config.agent = "HALL";
    config.modules = std::move(modules);
    bridge = std::make_unique<Bridge>(
        world.clock, world.hub, config,
        Bridge::Hooks{[this](const std::string& text) { notices.push_back(text); },
                      [](const std::string&) {}},
        [this](const Packet& the_will, Broker::Events events) {
          auto made = std::make_unique<MemoryBroker>();
          broker = made.get();
          will = the_will;
          broker->events = std::move(events);
          return made;
        });
    world.hub.set_on_presence([this](const auto& name, bool present, const auto& reason) {
      if (bridge) bridge->OnPresence(name, present, reason);
    });
    world.hub.router().set_on_unknown(
        [this](const std::string& name, Role asker) { return bridge->Open(name, asker); });
    GoOnline();
    Acknowledge();
  }
  /// Connected; `state` and `hub` stand at the broker under our name.
  void GoOnline(const std::string& state = "", const std::string& hub = "") {
    broker->events.on_online();
    ASSERT_EQ(broker->published.back().topic, "galatea/HALL/$reply");
    const Packet marker = broker->published.back();
    broker->published.pop_back();
    if (!state.empty()) broker->events.on_packet({"galatea/HALL/$state", state, true, "", ""});
    if (!hub.empty()) broker->events.on_packet({"galatea/HALL/$hub", hub, true, "", ""});
    broker->events.on_packet(marker);
  }
  /// Everything published so far has been taken by the broker, and is forgotten here.
  std::vector<Packet> Acknowledge() {
    const int taken = broker->last;
    while (acknowledged < taken) broker->events.on_receipt({++acknowledged, false, ""});
    return std::exchange(broker->published, {});
  }
  static Strings Texts(const std::vector<Packet>& packets) {
    Strings texts;
    for (const Packet& packet : packets)
      texts.push_back(packet.topic + " = " + packet.payload + (packet.retain ? " retained" : ""));
    return texts;
  }
  void Come(const std::string& topic, const std::string& payload, const std::string& answer_to = "",
            const std::string& correlation = "") {
    broker->events.on_packet({topic, payload, false, answer_to, correlation});
    world.clock.Settle();
    world.clock.RunReady();
  }

  World world;
  Strings notices;
  Packet will;
  std::unique_ptr<Bridge> bridge;
  MemoryBroker* broker = nullptr;
  int acknowledged = 0;
};

TEST_F(BridgeTest, ItsLastWillSaysThatTheAgentIsLost) {
  EXPECT_EQ(Texts({will}), Strings{"galatea/HALL/$state = LOST retained"});
}

TEST_F(BridgeTest, AModuleThatComesAndGoesIsSeen) {
  const auto ssm = world.JoinModern("SSM");
  EXPECT_EQ(Texts(Acknowledge()),
            (Strings{"galatea/HALL/SSM/$state = LIVE retained",
                     "galatea/HALL/$modules = AM AM-MCL FS-MCL SSM retained"}));
  world.Leave(*ssm, "killed by signal 9");
  EXPECT_EQ(Texts(Acknowledge()),
            (Strings{"galatea/HALL/SSM/$state = GONE killed by signal 9 retained",
                     "galatea/HALL/$modules = AM AM-MCL FS-MCL retained"}));
}

TEST_F(BridgeTest, ReportsAreRetainedAndEventsAreNot) {
  const auto ssm = world.JoinModern("SSM");
  Acknowledge();
  world.Say(*ssm, "rep Speak.stat = READY");
  world.Say(*ssm, "tell Speak.sync = 1000");
  world.Say(*ssm, "rep Text.error = BAD_VALUE nothing to say");
  EXPECT_EQ(Texts(Acknowledge()),
            (Strings{"galatea/HALL/SSM/Speak.stat = READY retained",
                     "galatea/HALL/SSM/$tell = Speak.sync = 1000",
                     "galatea/HALL/SSM/$error = rep Text.error = BAD_VALUE nothing to say"}));
}

TEST_F(BridgeTest, WhatAModuleHasReportedGoesWithIt) {
  const auto ssm = world.JoinModern("SSM");
  world.Say(*ssm, "rep Speak.stat = READY");
  Acknowledge();
  world.Leave(*ssm, "killed by signal 9");
  EXPECT_EQ(Texts(Acknowledge()),
            (Strings{"galatea/HALL/SSM/Speak.stat =  retained",
                     "galatea/HALL/SSM/$state = GONE killed by signal 9 retained",
                     "galatea/HALL/$modules = AM AM-MCL FS-MCL retained"}));
  broker->events.on_lost("the network is away");
  GoOnline();
  for (const std::string& text : Texts(Acknowledge()))
    EXPECT_EQ(text.find("Speak.stat"), std::string::npos) << text;
}

TEST_F(BridgeTest, GuestsThatAreModulesLeaveRoomForTheOthers) {
  const auto ssm = world.JoinModern("SSM");
  const auto guest = world.JoinAs(Role::kGuest, "ROBOT");
  world.Say(*guest, "rep Run = LIVE");
  world.hub.clocks().EndProbes(world.hub.clocks().Probing());
  world.clock.RunReady();
  constexpr std::size_t kShare = Publisher::kMaxValues / Publisher::kShareOfGuests;
  for (std::size_t i = 0; i < kShare + 10; ++i) {
    world.Say(*guest, "rep X" + std::to_string(i) + " = 1");
    Acknowledge();
  }
  ASSERT_FALSE(notices.empty());
  EXPECT_NE(notices.front().find("more than 4096 slots or 8388608 bytes of guests"),
            std::string::npos)
      << notices.front();
  world.Say(*guest, "rep X1 = 2");
  world.Say(*ssm, "rep Speak.stat = READY");
  EXPECT_EQ(Texts(Acknowledge()), (Strings{"galatea/HALL/ROBOT/X1 = 2 retained",
                                           "galatea/HALL/SSM/Speak.stat = READY retained"}));
}

TEST_F(BridgeTest, RequestsWhoseSlotARuleRenamesDoNotFillTheTable) {
  Rule rename;
  rename.slot = {"Text"};
  rename.new_slot = "Caption";
  world.hub.router().set_rules({rename});
  world.JoinModern("SSM");
  Acknowledge();
  for (std::size_t i = 0; i < LocalGateway::kMaxRequests + 10; ++i) {
    Come("galatea/HALL/SSM/Text/set", "hello", "me/answers");
    ASSERT_EQ(Texts(Acknowledge()), Strings{"me/answers = rep Caption = hello"}) << i;
  }
}

TEST_F(BridgeTest, BeyondTheLimitTheOldestRequestIsAnswered) {
  world.JoinModern("SSM");
  Acknowledge();
  world.answers = false;
  Limits limits = world.hub.limits();
  limits.pending = 100000;
  world.hub.set_limits(limits);
  for (std::size_t i = 0; i < LocalGateway::kMaxRequests; ++i)
    Come("galatea/HALL/SSM/Text/inq", "", "me/answers", std::to_string(i));
  EXPECT_EQ(Acknowledge().size(), 0u);
  Come("galatea/HALL/SSM/Text/inq", "", "me/answers", "one more");
  const auto answers = Acknowledge();
  ASSERT_EQ(Texts(answers),
            Strings{"me/answers = rep Text.error = LIMIT more than 4096 requests are unanswered"});
  EXPECT_EQ(answers[0].correlation, "0");
}

TEST_F(BridgeTest, WhatClientsReportIsNotShown) {
  const auto client = world.Join(PeerKind::kClient, "A");
  world.Say(*client, "rep X = 1");
  EXPECT_EQ(Acknowledge().size(), 0u);
}

TEST_F(BridgeTest, ACommandIsAnsweredWhereItSaysWithItsCorrelationData) {
  const auto ssm = world.JoinModern("SSM");
  Acknowledge();
  Come("galatea/HALL/$do/SSM", "set Speak = NOW", "me/answers", std::string("\0\xff", 2));
  const auto answers = Acknowledge();
  ASSERT_EQ(Texts(answers), Strings{"me/answers = rep Speak = NOW"});
  EXPECT_EQ(answers[0].correlation, std::string("\0\xff", 2));
  Come("galatea/HALL/SSM/Text/set", "hello", "me/answers");
  Come("galatea/HALL/SSM/Text/inq", "", "me/answers");
  EXPECT_EQ(Texts(Acknowledge()),
            (Strings{"me/answers = rep Text = hello", "me/answers = rep Text = "}));
}

TEST_F(BridgeTest, WhatCannotBeDoneIsOneAnswerAndOneNotice) {
  world.JoinModern("SSM");
  Acknowledge();
  const std::tuple<std::string, std::string, std::string> table[] = {
      {"$do/SSM", "jump Speak", "rep Error = UNKNOWN_COMMAND"},
      {"$do/SSM", "", "rep Error = EMPTY"},
      {"$do/SSM", "set Text = a\nset Text = b", "rep Error = SYNTAX"},
      {"$do/SSM", "set Text = \xff", "rep Error = BAD_UTF8"},
      {"$do/SSM", "set Text = " + std::string(70000, 'x'), "rep Error = TOO_LONG"},
      {"$do/SSM", "rep Speak.stat = IDLE", "rep Error = UNKNOWN_COMMAND"},
      {"$do/SSM", "to @AM set Run = EXIT", "rep Run.error = SYNTAX"},
      {"SSM/Text/set", "a\nto @AM set Run = EXIT", "rep Text.error = BAD_VALUE"},
      {"$do/AM", "set Name = SSM", "rep Name.error = ACCESS"},
      {"$do/MQTT", "set X = 1", "rep X.error = ACCESS"},
      {"SSM/Te xt/set", "a", "rep Error = SYNTAX"},
  };
  for (const auto& [topic, payload, expected] : table) {
    notices.clear();
    world.clock.RunUntil(world.clock.Now() + std::chrono::seconds(2));
    Come("galatea/HALL/" + topic, payload, "me/answers");
    const auto answers = Acknowledge();
    ASSERT_EQ(answers.size(), 1u) << topic << " " << payload.substr(0, 50);
    EXPECT_TRUE(answers[0].payload.starts_with(expected)) << answers[0].payload;
    ASSERT_EQ(notices.size(), 1u) << payload.substr(0, 50);
    EXPECT_NE(notices[0].find("galatea/HALL/" + topic), std::string::npos) << notices[0];
  }
  Come("galatea/HALL/$do/NOBODY", "set X = 1", "me/answers");
  EXPECT_TRUE(Acknowledge().at(0).payload.starts_with("rep X.error = UNKNOWN_MODULE"));
}

TEST_F(BridgeTest, ModulesThatAreNotShownCannotBeSpokenToEither) {
  Start({"SS*"});
  const auto srm = world.JoinModern("SRM");
  world.JoinModern("SSM");
  world.Say(*srm, "rep Result = yes");
  const Strings seen = Texts(Acknowledge());
  EXPECT_EQ(seen, (Strings{"galatea/HALL/SSM/$state = LIVE retained",
                           "galatea/HALL/$modules = SSM retained"}));
  Come("galatea/HALL/$do/SRM", "set Listen = NOW", "me/answers");
  EXPECT_TRUE(Acknowledge().at(0).payload.starts_with("rep Listen.error = ACCESS"));
  Come("galatea/HALL/$do/AM", "set Run = EXIT", "me/answers");
  EXPECT_TRUE(Acknowledge().at(0).payload.starts_with("rep Run.error = ACCESS"));
}

TEST_F(BridgeTest, AnAnswerCannotBeMadeACommandToSomebodyElse) {
  world.JoinModern("SSM");
  Acknowledge();
  for (const char* topic : {"galatea/LOBBY/SSM/Text/set", "galatea/LOBBY/$do/SSM",
                            "galatea/LOBBY/SSM/Speak.stat", "galatea/x/y/z/w/v"})
    Come("galatea/HALL/$do/SSM", "set Text = hello", topic);
  EXPECT_EQ(Acknowledge().size(), 0u);
  EXPECT_EQ(notices.size(), 4u);
  Come("galatea/HALL/$do/SSM", "set Text = hello", "galatea/LOBBY/$reply");
  EXPECT_EQ(Texts(Acknowledge()), Strings{"galatea/LOBBY/$reply = rep Text = hello"});
}

TEST_F(BridgeTest, AFloodOfBadPacketsIsNoFloodOfNotices) {
  for (int i = 0; i < 1000; ++i) Come("galatea/HALL/$do/SSM", "jump");
  EXPECT_EQ(notices.size(), 10u);
}

TEST_F(BridgeTest, AModuleOfAnotherAgentIsSpokenToAndAnswers) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @LOBBY/FSM set#1 Gaze = 1 2");
  const auto sent = Acknowledge();
  ASSERT_EQ(Texts(sent), Strings{"galatea/LOBBY/$do/FSM = set Gaze = 1 2"});
  EXPECT_EQ(sent[0].response_topic, "galatea/HALL/$reply");
  Come("galatea/HALL/$reply", "rep Gaze = 1 2", "", sent[0].correlation);
  EXPECT_EQ(a->heard, Strings{"From @LOBBY/FSM rep#1 Gaze = 1 2"});
}

TEST_F(BridgeTest, RequestsBeyondTheWindowWaitForAnswersAndKeepTheirOrder) {
  const auto a = world.Join(PeerKind::kClient, "A");
  const std::size_t all = RequestWindow::kMaxUnanswered + 10;
  for (std::size_t i = 0; i < all; ++i)
    world.Say(*a, "to @LOBBY/FSM set#" + std::to_string(i) + " X = " + std::to_string(i));
  auto sent = Acknowledge();
  ASSERT_EQ(sent.size(), RequestWindow::kMaxUnanswered);
  for (std::size_t i = 0; i < all; ++i) {
    ASSERT_LT(i, sent.size());
    EXPECT_EQ(sent[i].payload, "set X = " + std::to_string(i));
    Come("galatea/HALL/$reply", "rep X = " + std::to_string(i), "", sent[i].correlation);
    for (const Packet& packet : Acknowledge()) sent.push_back(packet);
  }
  EXPECT_EQ(a->heard.size(), all);
  EXPECT_EQ(a->heard.back(),
            "From @LOBBY/FSM rep#" + std::to_string(all - 1) + " X = " + std::to_string(all - 1));
}

TEST_F(BridgeTest, AnAnswerNobodyAskedForIsHeardByNobody) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @LOBBY/FSM set#1 Gaze = 1 2");
  Acknowledge();
  Come("galatea/HALL/$reply", "rep Gaze = 1 2", "", "0000000000000000 LOBBY/FSM h1");
  Come("galatea/HALL/$reply", "rep Gaze = 1 2", "", "");
  EXPECT_EQ(a->heard, Strings{});
  EXPECT_EQ(notices.size(), 2u);
}

TEST_F(BridgeTest, WithoutSuchAnAgentTheRequestIsAnsweredAtOnce) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @NOWHERE/FSM set#1 Gaze = 1 2");
  broker->events.on_receipt({broker->last, true, ""});
  world.clock.Settle();
  ASSERT_EQ(a->heard.size(), 1u);
  EXPECT_TRUE(a->heard[0].starts_with("From @NOWHERE/FSM rep#1 Gaze.error = UNAVAILABLE"))
      << a->heard[0];
  EXPECT_FALSE(world.hub.directory().IsPresent("NOWHERE/FSM"));
  EXPECT_EQ(std::ranges::count_if(broker->filters,
                                  [](const auto& f) { return f.starts_with("galatea/NOWHERE"); }),
            0);
}

TEST_F(BridgeTest, WhoIsLostAnswersNoMore) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @LOBBY/FSM set#1 Gaze = 1 2");
  Come("galatea/LOBBY/$state", "LOST");
  ASSERT_EQ(a->heard.size(), 1u);
  EXPECT_NE(
      a->heard[0].find("Gaze.error = UNAVAILABLE @LOBBY/FSM has gone (the agent LOBBY is LOST)"),
      std::string::npos)
      << a->heard[0];
  world.Say(*a, "to @LOBBY/SSM set#2 Text = x");
  Come("galatea/LOBBY/SSM/$state", "GONE killed by signal 9");
  EXPECT_NE(a->heard.back().find("GONE killed by signal 9"), std::string::npos) << a->heard.back();
}

TEST_F(BridgeTest, OneOfOurOwnIsNotReachedByTheBroker) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @HALL/FSM set#1 Gaze = 1 2");
  EXPECT_NE(a->heard.at(0).find("Gaze.error = UNKNOWN_MODULE"), std::string::npos);
  EXPECT_NE(a->heard.at(0).find("to @FSM"), std::string::npos) << a->heard[0];
}

TEST_F(BridgeTest, WhoSubscribesHearsAnotherAgentsModuleAlsoAfterItHasBeenAway) {
  const auto a = world.Join(PeerKind::kClient, "A");
  const auto dm = world.Join(PeerKind::kClient, "DM");
  world.hub.router().set_broadcast({"DM"});
  world.hub.Subscribe(a->key, {"LOBBY/SRM"});
  bridge->Want("LOBBY/SRM", Role::kOwner);
  Come("galatea/LOBBY/SRM/Result", "yes");
  Come("galatea/LOBBY/SRM/$tell", "a door");
  EXPECT_EQ(a->heard, (Strings{"From @LOBBY/SRM rep Result = yes", "From @LOBBY/SRM tell a door"}));
  Come("galatea/LOBBY/$state", "LOST");
  EXPECT_FALSE(world.hub.directory().IsPresent("LOBBY/SRM"));
  Come("galatea/LOBBY/$state", "ONLINE");
  Come("galatea/LOBBY/SRM/Result", "no");
  EXPECT_EQ(a->heard.back(), "From @LOBBY/SRM rep Result = no");
  EXPECT_EQ(dm->heard, Strings{}) << "what is broadcast here is what our own modules say";
  EXPECT_EQ(std::ranges::count_if(
                broker->published,
                [](const Packet& packet) { return packet.topic.starts_with("galatea/LOBBY/SRM"); }),
            0)
      << "what came from the broker does not go back there";
}

TEST_F(BridgeTest, AStartTimeCountsOnTheOtherHubsClock) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.clock.RunUntil(std::chrono::seconds(5));
  world.Say(*a, "to @LOBBY/FSM set Speak = @6000");
  world.Say(*a, "to @LOBBY/FSM set Gaze = 0 0");
  world.clock.RunReady();
  Strings sent;
  int asked = 0;
  for (int i = 0; i < 6; ++i) {
    for (const Packet& packet : Acknowledge()) {
      if (packet.payload != "inq Clock") {
        sent.push_back(packet.payload);
        continue;
      }
      ++asked;
      EXPECT_EQ(packet.topic, "galatea/LOBBY/$do/AM");
      Come("galatea/HALL/$reply", "rep Clock = 65000.000", "", packet.correlation);
    }
  }
  EXPECT_EQ(asked, 5);
  EXPECT_EQ(sent, (Strings{"set Speak = @66000", "set Gaze = 0 0"})) << "in their order";
  world.Say(*a, "to @LOBBY/FSM set Speak = @7000");
  EXPECT_EQ(Acknowledge().at(0).payload, "set Speak = @67000");
}

TEST_F(BridgeTest, WhoDoesNotTellItsClockGetsTheStartAtItsTime) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @LOBBY/FSM set Speak = @6000");
  world.clock.RunReady();
  const auto question = Acknowledge().at(0);
  ASSERT_EQ(question.payload, "inq Clock");
  Come("galatea/HALL/$reply", "rep Clock.error = UNKNOWN_SLOT no clock", "", question.correlation);
  EXPECT_EQ(Acknowledge().size(), 0u);
  world.clock.RunUntil(std::chrono::seconds(6));
  EXPECT_EQ(Acknowledge().at(0).payload, "set Speak = NOW");
}

TEST_F(BridgeTest, AfterALossEveryValueIsPublishedAgainAndOnlyTheLatest) {
  const auto ssm = world.JoinModern("SSM");
  world.Say(*ssm, "rep Speak.stat = READY");
  Acknowledge();
  broker->events.on_lost("gone");
  world.clock.Settle();
  EXPECT_EQ(bridge->State(), "AWAY gone");
  world.Say(*ssm, "rep Speak.stat = SPEAKING");
  world.Say(*ssm, "rep Speak.stat = IDLE");
  EXPECT_EQ(broker->published.size(), 0u);
  GoOnline("LOST", "0");
  const Strings again = Texts(Acknowledge());
  EXPECT_EQ(std::ranges::count(again, "galatea/HALL/SSM/Speak.stat = IDLE retained"), 1);
  EXPECT_EQ(std::ranges::count(again, "galatea/HALL/$state = ONLINE retained"), 1);
  EXPECT_EQ(again.size(), 5u) << "the two above, $hub, $modules, and the module's $state";
}

TEST_F(BridgeTest, ANameAnotherHubHasIsLeftToIt) {
  broker->events.on_lost("gone");
  world.clock.Settle();
  GoOnline("ONLINE", "of another");
  EXPECT_EQ(bridge->State(), "AWAY another hub goes by the name HALL there");
  EXPECT_EQ(broker->published.size(), 0u) << "nothing is said in its name";
  GoOnline("LOST", "of another");
  EXPECT_EQ(bridge->State(), "ONLINE tcp:127.0.0.1:1883 as HALL");
}

TEST_F(BridgeTest, OfTwoThatTakeANameInOneMomentOneStays) {
  Acknowledge();
  Come("galatea/HALL/$hub", "!");  // before all that a name of ours can begin with
  const auto said = Acknowledge();
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].topic, "galatea/HALL/$hub");
  EXPECT_TRUE(bridge->online());
  Come("galatea/HALL/$hub", said[0].payload);
  EXPECT_TRUE(bridge->online()) << "its own";
  Come("galatea/HALL/$hub", "~");  // after all
  EXPECT_FALSE(bridge->online());
}

TEST_F(BridgeTest, WhileTheBrokerIsAwayARequestIsAnsweredThatItIs) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @LOBBY/FSM set#1 Gaze = 1 2");
  broker->events.on_lost("gone");
  world.clock.Settle();
  ASSERT_EQ(a->heard.size(), 1u);
  EXPECT_NE(a->heard[0].find("UNAVAILABLE"), std::string::npos);
  world.Say(*a, "to @LOBBY/FSM set#2 Gaze = 1 2");
  EXPECT_NE(a->heard.back().find("rep#2 Gaze.error = UNAVAILABLE @LOBBY/FSM cannot be reached"),
            std::string::npos)
      << a->heard.back();
}

TEST_F(BridgeTest, ABrokerThatTakesNothingGetsTheLatestValuesLater) {
  const auto ssm = world.JoinModern("SSM");
  Acknowledge();
  for (int i = 0; i < 100; ++i)
    world.Say(*ssm, "rep Big = " + std::to_string(i) + std::string(60000, 'x'));
  EXPECT_LE(broker->published.size(), Publisher::kMaxInFlightBytes / 60000 + 1);
  world.Say(*ssm, "tell lost");
  EXPECT_EQ(bridge->dropped(), 1u);
  const auto taken = Acknowledge();
  EXPECT_LT(taken.size(), 30u);
  EXPECT_TRUE(taken.back().payload.starts_with("99")) << "the latest, once there is room";
}

TEST_F(BridgeTest, WhatTheBrokerRefusesIsSaid) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @LOBBY/FSM set#1 Gaze = 1 2");
  broker->events.on_receipt({broker->last, false, "Not authorized"});
  world.clock.Settle();
  ASSERT_EQ(a->heard.size(), 1u);
  EXPECT_NE(a->heard[0].find("Not authorized"), std::string::npos) << a->heard[0];
  EXPECT_NE(notices.at(0).find("galatea/LOBBY/$do/FSM"), std::string::npos) << notices[0];
}

TEST_F(BridgeTest, WhoSpeaksToTheBrokerItselfIsAnswered) {
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @MQTT set#1 X = 1");
  world.clock.RunReady();
  ASSERT_EQ(a->heard.size(), 1u);
  EXPECT_NE(a->heard[0].find("rep#1 X.error = UNKNOWN_SLOT"), std::string::npos) << a->heard[0];
}

TEST_F(BridgeTest, ARefusalCannotBeMadeACommandToSomebodyElseEither) {
  world.JoinModern("SSM");
  Acknowledge();
  for (const char* topic : {"galatea/LOBBY/SSM/Text/set", "galatea/LOBBY/$do/SSM"}) {
    Come("galatea/HALL/$do/SSM", "jump", topic);           // cannot be parsed
    Come("galatea/HALL/$do/AM", "set Name = SSM", topic);  // may not be said
    Come("galatea/HALL/x/y/z", "", topic);                 // no topic of ours
  }
  EXPECT_EQ(Texts(Acknowledge()), Strings{});
  EXPECT_EQ(notices.size(), 6u);
}

TEST_F(BridgeTest, WhatARequestIsRememberedByIsBounded) {
  world.JoinModern("SSM");
  Acknowledge();
  Come("galatea/HALL/$do/SSM", "set Text = a", "me/" + std::string(60000, 'x'));
  EXPECT_TRUE(Acknowledge().at(0).payload.starts_with("rep Text.error = LIMIT"));
  Come("galatea/HALL/$do/SSM", "set Text = a", "me/answers", std::string(60000, 'x'));
  EXPECT_TRUE(Acknowledge().at(0).payload.starts_with("rep Text.error = LIMIT"));
}

TEST_F(BridgeTest, AnswersThatTheBrokerDoesNotTakeAreBounded) {
  world.JoinModern("SSM");
  Acknowledge();
  for (int i = 0; i < 200; ++i)
    Come("galatea/HALL/SSM/Text/set", std::string(60000, 'x'), "me/answers");
  EXPECT_LE(broker->published.size(), Publisher::kMaxInFlightBytesOfAnswers / 60000 + 1);
  EXPECT_GT(bridge->dropped(), 0u);
  Acknowledge();
  Come("galatea/HALL/SSM/Text/set", "hello", "me/answers");
  EXPECT_EQ(Texts(Acknowledge()), Strings{"me/answers = rep Text = hello"});
}

TEST_F(BridgeTest, ANumberThatComesTwiceBeforeItsReceiptIsCountedTwice) {
  const auto ssm = world.JoinModern("SSM");
  Acknowledge();
  const int number = broker->last + 1;
  for (int i = 0; i < 40; ++i) {
    for (int twice = 0; twice < 2; ++twice) {
      broker->last = number - 1;
      world.Say(*ssm, "tell " + std::string(60000, 'x'));
    }
    for (int twice = 0; twice < 2; ++twice) broker->events.on_receipt({number, false, ""});
  }
  EXPECT_EQ(broker->published.size(), 80u);
  EXPECT_EQ(bridge->dropped(), 0u);
}

TEST_F(BridgeTest, WhatStandsAtTheBrokerDoesNotTellHowToAnswerForAnother) {
  broker->events.on_lost("gone");
  world.clock.Settle();
  GoOnline();
  std::string hub;
  for (const Packet& packet : Acknowledge()) {
    if (packet.topic == "galatea/HALL/$hub") hub = packet.payload;
  }
  ASSERT_NE(hub, "");
  const auto a = world.Join(PeerKind::kClient, "A");
  world.Say(*a, "to @LOBBY/FSM set#1 Gaze = 1 2");
  world.Say(*a, "to @ATTIC/FSM set#2 Gaze = 3 4");
  const auto sent = Acknowledge();
  ASSERT_EQ(sent.size(), 2u);
  EXPECT_EQ(sent[0].correlation.find(hub), std::string::npos) << "anybody can read $hub";
  // What ATTIC has been sent does not serve it to answer for LOBBY.
  const std::string secret = sent[1].correlation.substr(0, sent[1].correlation.find(' '));
  const std::string rest = sent[0].correlation.substr(sent[0].correlation.find(' '));
  Come("galatea/HALL/$reply", "rep Gaze = 1 2", "", secret + rest);
  EXPECT_EQ(a->heard, Strings{});
  EXPECT_EQ(notices.size(), 1u);
}

TEST_F(BridgeTest, WhatAnotherAgentSaysOfItselfStaysOneLine) {
  const auto a = world.Join(PeerKind::kClient, "A");
  const std::string payload = "GONE\nrep#9 Forged = 1 \xff" + std::string(200, 'x');
  for (const char* topic : {"galatea/LOBBY/SSM/$state", "galatea/LOBBY/$state"}) {
    a->heard.clear();
    world.Say(*a, "to @LOBBY/SSM set#1 Text = x");
    Come(topic, payload);
    ASSERT_EQ(a->heard.size(), 1u);
    EXPECT_TRUE(vm::ParseMessage(a->heard[0])) << a->heard[0];
    EXPECT_EQ(a->heard[0].find('\n'), std::string::npos) << a->heard[0];
  }
}

TEST_F(BridgeTest, OnlyModulesOfOtherAgentsAreFollowedAtTheBroker) {
  const auto filters = broker->filters;
  for (const char* name : {"HALL/SSM", "LOBBY/#", "+/+", "LOBBY/", "/SSM", "LOBBY/a/b"})
    bridge->Want(name, Role::kOwner);
  EXPECT_EQ(broker->filters, filters);
  broker->events.on_lost("gone");
  world.clock.Settle();
  broker->filters.clear();
  GoOnline();
  for (const std::string& filter : broker->filters)
    EXPECT_TRUE(std::ranges::find(filters, filter) != filters.end()) << filter;
}

TEST_F(BridgeTest, WhoIsWantedWhileTheHubIsFullIsHeardLater) {
  const std::size_t peers = world.hub.limits().peers;
  const auto a = world.Join(PeerKind::kClient, "A");
  world.hub.Subscribe(a->key, {"LOBBY/SRM"});
  world.hub.set_limit(&Limits::peers, 1);
  bridge->Want("LOBBY/SRM", Role::kOwner);
  EXPECT_FALSE(world.hub.directory().IsPresent("LOBBY/SRM"));
  EXPECT_EQ(std::ranges::count(broker->filters, "galatea/LOBBY/SRM/+"), 1);
  world.hub.set_limit(&Limits::peers, peers);
  Come("galatea/LOBBY/SRM/$state", "LIVE");
  EXPECT_TRUE(world.hub.directory().IsPresent("LOBBY/SRM"));
}

TEST_F(BridgeTest, NamesThatNobodyIsSubscribedToAnyMoreMakeRoomForOthers) {
  world.hub.set_limit(&Limits::peers, 1);  // none of them can be attached
  for (std::size_t i = 0; i < RemoteModules::kMaxRemotes; ++i)
    bridge->Want("LOBBY/M" + std::to_string(i), Role::kOwner);
  bridge->Want("LOBBY/SRM", Role::kOwner);
  EXPECT_EQ(std::ranges::count(broker->filters, "galatea/LOBBY/SRM/+"), 1);
}

TEST_F(BridgeTest, NamesOfNobodyTakeNoPlaceOfOthers) {
  const auto guest = world.JoinAs(Role::kGuest, "GUEST");
  std::set<std::string> names;
  for (int i = 0; i < 200; ++i) names.insert("NOBODY" + std::to_string(i) + "/X");
  world.hub.Subscribe(guest->key, names);
  for (const std::string& name : names) bridge->Want(name, Role::kGuest);
  EXPECT_EQ(world.hub.directory().Names(), (Strings{"GUEST", "MQTT"}))
      << "nobody has said that they are there";
  EXPECT_TRUE(world.hub.HasSubscriber("NOBODY7/X"));
  // Nor do those who are asked for take the places of guests, or all that there are.
  world.hub.set_limit(&Limits::peers, 16);
  constexpr std::size_t kShare = RemoteModules::kMaxRemotes / RemoteModules::kShareOfGuests;
  for (std::size_t i = 0; i < kShare + 100; ++i)
    world.Say(*guest, "to @LOBBY/M" + std::to_string(i) + " set X = 1");
  world.clock.Settle();
  EXPECT_LE(world.hub.directory().Names().size(), kShare + 2);
  const auto other = world.JoinAs(Role::kGuest, "OTHER");
  EXPECT_NE(other->key, 0u);
  const auto client = world.JoinAs(Role::kClient, "A");
  world.Say(*client, "to @LOBBY/SSM set#1 Text = x");
  EXPECT_EQ(client->heard, Strings{}) << "it waits for its answer";
  world.Leave(*guest, "it goes");
  EXPECT_FALSE(world.hub.HasSubscriber("NOBODY7/X"));
}

TEST_F(BridgeTest, QuestionsThatWaitCountForTheBacklog) {
  const auto a = world.Join(PeerKind::kClient, "A");
  for (std::size_t i = 0; i < RequestWindow::kMaxUnanswered + 10; ++i)
    world.Say(*a, "to @LOBBY/FSM inq#" + std::to_string(i) + " X");
  Acknowledge();
  for (const PeerStatus& peer : world.hub.Status()) {
    if (peer.name == "LOBBY/FSM") {
      EXPECT_GT(peer.backlog_bytes, 10u);
    }
  }
}

}  // namespace
}  // namespace am::mqtt
