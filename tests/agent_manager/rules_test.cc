#include "agent_manager/routing/rules.h"

#include <gtest/gtest.h>

#include "agent_manager/config/config.h"
#include "tests/agent_manager/world.h"

namespace am {
namespace {

using std::chrono::milliseconds;
using Strings = std::vector<std::string>;

class RulesTest : public testing::Test {
 protected:
  RulesTest() {
    a_ = world_.Join(PeerKind::kClient, "A");
    b_ = world_.Join(PeerKind::kClient, "B");
    c_ = world_.Join(PeerKind::kClient, "C");
  }
  /// Rules as they stand in a configuration.
  void Use(const std::string& rules) {
    const auto config = ParseConfig("{\"rules\": " + rules + "}", "am.json", ".");
    ASSERT_TRUE(config) << config.error().text;
    world_.hub.router().set_rules(config->rules);
  }
  World world_;
  std::shared_ptr<World::Peer> a_, b_, c_;
};

TEST(MatchesPatternTest, AStarStandsForAnyText) {
  for (const auto& [pattern, text] :
       std::vector<std::pair<const char*, const char*>>{{"*", ""},
                                                        {"*", "x"},
                                                        {"a*c", "abbc"},
                                                        {"a*b*", "axxbyy"},
                                                        {"*a*a", "banana"},
                                                        {"", ""},
                                                        {"Speak*", "Speak.stat"}})
    EXPECT_TRUE(MatchesPattern(pattern, text)) << pattern << " " << text;
  for (const auto& [pattern, text] : std::vector<std::pair<const char*, const char*>>{
           {"", "x"}, {"a", "A"}, {"a*c", "abd"}, {"*a*a", "ban"}, {"Speak", "Speak.stat"}})
    EXPECT_FALSE(MatchesPattern(pattern, text)) << pattern << " " << text;
}

TEST(MatchesPatternTest, ManyStarsTakeNoLongTime) {
  std::string pattern;
  for (int i = 0; i < 1000; ++i) pattern += "a*";
  EXPECT_FALSE(MatchesPattern(pattern + "b", std::string(20000, 'a')));
}

TEST_F(RulesTest, ACopyNamesNoFileThatItsSenderMayNotName) {
  const auto guest = world_.JoinAs(Role::kGuest, "GUEST");
  Use(R"([{"from": "GUEST", "copy_to": "@B"}])");
  world_.Say(*guest, "to @A set SaveWAV = /tmp/x.wav");
  world_.Say(*guest, "to @A set Text = hello");
  EXPECT_EQ(a_->heard, Strings{"set Text = hello"});
  EXPECT_EQ(b_->heard, Strings{"set Text = hello"});
}

TEST_F(RulesTest, WhatRulesDelayIsBounded) {
  Use(R"([{"slot": "Late", "delay_ms": 60000}])");
  world_.hub.set_limit(&Limits::backlog_bytes, 100000);
  const std::string value(30000, 'x');
  for (int i = 0; i < 5; ++i)
    world_.Say(*a_, "to @B set#" + std::to_string(i) + " Late = " + value);
  ASSERT_EQ(a_->heard.size(), 2u);
  EXPECT_NE(a_->heard[0].find("rep#3 Late.error = LIMIT"), std::string::npos) << a_->heard[0];
  world_.Say(*c_, "to @B set Late = " + value);
  EXPECT_EQ(c_->heard, Strings{}) << "another peer has room of its own";
  world_.clock.RunUntil(milliseconds(60000));
  EXPECT_EQ(b_->heard.size(), 4u);
  world_.Say(*a_, "to @B set Late = " + value);
  EXPECT_EQ(a_->heard.size(), 2u) << "the room is given back";
}

TEST_F(RulesTest, RewriteChangesReceiverSlotAndValue) {
  Use(R"([{"from": "A", "to": "B", "slot": "Text", "rewrite":
          {"to": "C", "slot": "Text.loud", "value": "${from} says ${value}!"}}])");
  world_.Say(*a_, "to @B set Text = hello");
  world_.Say(*a_, "to @B set Other = 1");
  EXPECT_EQ(c_->heard, Strings{"set Text.loud = A says hello!"});
  EXPECT_EQ(b_->heard, Strings{"set Other = 1"});
}

TEST_F(RulesTest, RewritingReportsWorksToo) {
  Use(R"([{"from": "A", "command": "rep", "slot": "Level", "rewrite": {"value": "${value} dB"}}])");
  world_.Say(*a_, "to @B rep Level = 5");
  EXPECT_EQ(b_->heard, Strings{"From @A rep Level = 5 dB"});
}

TEST_F(RulesTest, CopiesAreAsTheMessageCame) {
  Use(R"([{"to": "B", "slot": "Speak*", "copy_to": "@C", "rewrite": {"value": "STOP"}}])");
  world_.Say(*a_, "to @B set#1 Speak = NOW");
  world_.Say(*a_, "to @B rep Speak.stat = IDLE");
  EXPECT_EQ(c_->heard, (Strings{"set Speak = NOW", "From @A rep Speak.stat = IDLE"}));
  EXPECT_EQ(b_->heard[0].substr(b_->heard[0].find(' ')), " Speak = STOP");
}

TEST_F(RulesTest, WhatIsDroppedIsAnsweredOnlyToWhoAsked) {
  Use(R"([{"name": "quiet", "to": "B", "command": ["set", "do"], "drop": true},
          {"to": "C", "refuse": "C sleeps"}])");
  world_.Say(*a_, "to @B set X = 1");
  EXPECT_EQ(a_->heard, Strings{});
  world_.Say(*a_, "to @B set#1 X = 1");
  world_.Say(*a_, "to @C set#2 X = 1");
  EXPECT_EQ(b_->heard, Strings{});
  EXPECT_EQ(a_->heard, (Strings{"From @AM rep#1 X.error = ACCESS dropped by quiet",
                                "From @AM rep#2 X.error = ACCESS C sleeps"}));
}

TEST_F(RulesTest, DelayKeepsTheOrder) {
  Use(R"([{"to": "B", "delay_ms": 100}])");
  for (int i = 0; i < 3; ++i) {
    world_.Say(*a_, "to @B set X = " + std::to_string(i));
    world_.clock.RunUntil(world_.clock.Now() + milliseconds(10));
  }
  EXPECT_EQ(b_->heard, Strings{});
  EXPECT_TRUE(world_.hub.HoldsBack());
  world_.clock.RunUntil(milliseconds(105));
  EXPECT_EQ(b_->heard, Strings{"set X = 0"});
  world_.clock.RunUntil(milliseconds(200));
  EXPECT_EQ(b_->heard, (Strings{"set X = 0", "set X = 1", "set X = 2"}));
  EXPECT_FALSE(world_.hub.HoldsBack());
}

TEST_F(RulesTest, ThrottleCountsEachSenderOnItsOwn) {
  Use(R"([{"to": "B", "per_second": 10}])");
  for (int i = 0; i < 100; ++i) {
    world_.Say(*a_, "to @B set X = a");
    if (i < 5) world_.Say(*c_, "to @B set X = c");
  }
  EXPECT_EQ(std::ranges::count(b_->heard, "set X = a"), 10);
  EXPECT_EQ(std::ranges::count(b_->heard, "set X = c"), 5);
  world_.clock.RunUntil(milliseconds(1000));
  world_.Say(*a_, "to @B set X = a");
  EXPECT_EQ(std::ranges::count(b_->heard, "set X = a"), 11);
}

TEST_F(RulesTest, ThrottleCountsASenderOnWhateverItCallsItself) {
  Use(R"([{"to": "B", "per_second": 10}])");
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(world_.hub.Rename(a_->key, "N" + std::to_string(i)));
    world_.Say(*a_, "to @B set X = a");
  }
  EXPECT_EQ(b_->heard.size(), 10U);
}

TEST_F(RulesTest, LastEndsTheRulesAndNotesAreForPeople) {
  std::string noted;
  world_.hub.set_on_notice([&](const std::string& text, PeerKey) { noted += text; });
  Use(R"([{"from": "A", "name": "watch", "note": true, "last": true}, {"drop": true}])");
  world_.Say(*a_, "to @B set X = 1");
  world_.Say(*c_, "to @B set X = 2");
  EXPECT_EQ(b_->heard, Strings{"set X = 1"});
  EXPECT_EQ(noted, "watch: @A set X = 1");
}

TEST_F(RulesTest, ARewriteThatMakesNoMessageDropsIt) {
  Use(R"([{"rewrite": {"slot": "not a slot"}}])");
  world_.Say(*a_, "to @B set#1 X = 1");
  EXPECT_EQ(b_->heard, Strings{});
  EXPECT_NE(a_->heard.back().find("rule 1 makes a line of it that is no message"),
            std::string::npos);
}

TEST(RulesConfigTest, FaultsNameTheRule) {
  for (const auto& [text, part] : std::vector<std::pair<const char*, const char*>>{
           {R"([{"from": "A"}])", "rules[0]: expected what to do"},
           {R"([{"drop": 1}])", "rules[0].drop: found 1, expected true or false"},
           {R"([{"command": "sing", "drop": true}])", "rules[0].command"},
           {R"([{"rewrite": {"form": "x"}}])", "rules[0].rewrite.form: unknown key"}}) {
    const auto config = ParseConfig(std::string("{\"rules\": ") + text + "}", "am.json", ".");
    ASSERT_FALSE(config) << text;
    EXPECT_NE(config.error().text.find(part), std::string::npos) << config.error().text;
  }
}

}  // namespace
}  // namespace am
