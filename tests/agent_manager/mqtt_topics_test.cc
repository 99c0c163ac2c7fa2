#include <gtest/gtest.h>

#include "agent_manager/mqtt/topics.h"

namespace am::mqtt {
namespace {

using Kind = Topic::Kind;

TEST(MqttTopicsTest, EveryKindOfTopicIsReadAsItWasWritten) {
  const std::pair<Topic, std::string> table[] = {
      {{Kind::kState, "LOBBY", "", ""}, "galatea/LOBBY/$state"},
      {{Kind::kHub, "LOBBY", "", ""}, "galatea/LOBBY/$hub"},
      {{Kind::kModules, "LOBBY", "", ""}, "galatea/LOBBY/$modules"},
      {{Kind::kReply, "LOBBY", "", ""}, "galatea/LOBBY/$reply"},
      {{Kind::kDo, "LOBBY", "FSM", ""}, "galatea/LOBBY/$do/FSM"},
      {{Kind::kModuleState, "LOBBY", "FSM", ""}, "galatea/LOBBY/FSM/$state"},
      {{Kind::kSlot, "LOBBY", "SSM", "Speak.stat"}, "galatea/LOBBY/SSM/Speak.stat"},
      {{Kind::kTell, "LOBBY", "SSM", ""}, "galatea/LOBBY/SSM/$tell"},
      {{Kind::kError, "LOBBY", "SSM", ""}, "galatea/LOBBY/SSM/$error"},
      {{Kind::kSet, "LOBBY", "SSM", "Text"}, "galatea/LOBBY/SSM/Text/set"},
      {{Kind::kInq, "LOBBY", "SSM", "Text"}, "galatea/LOBBY/SSM/Text/inq"},
  };
  for (const auto& [topic, text] : table) {
    EXPECT_EQ(FormatTopic("galatea", topic), text);
    EXPECT_EQ(ParseTopic("galatea", text), topic) << text;
  }
}

TEST(MqttTopicsTest, TheRootMayHaveLevels) {
  const auto topic = ParseTopic("museum/hall-2", "museum/hall-2/LOBBY/FSM/Gaze");
  ASSERT_TRUE(topic) << topic.error().text;
  EXPECT_EQ(topic->agent, "LOBBY");
  EXPECT_EQ(topic->slot, "Gaze");
}

TEST(MqttTopicsTest, WhatIsNoneOfOursIsRefusedWithWhatWasExpected) {
  const std::pair<std::string, std::string> table[] = {
      {"other/LOBBY/$state", "below galatea/"},
      {"galatea", "below galatea/"},
      {"galateas/LOBBY/$state", "below galatea/"},
      {"galatea/LO BBY/$state", "an agent's name"},
      {"galatea//$state", "an agent's name"},
      {"galatea/LOBBY", "AGENT/MODULE/SLOT"},
      {"galatea/LOBBY/FSM", "$modules or $reply"},
      {"galatea/LOBBY/F+M/Gaze", "a module's name"},
      {"galatea/LOBBY/$do/FSM/Gaze", "AGENT/$do/MODULE"},
      {"galatea/LOBBY/FSM/Ga ze", "a slot's name"},
      {"galatea/LOBBY/FSM/Gaze/get", "set or inq"},
      {"galatea/LOBBY/FSM/Gaze/set/1", "AGENT/MODULE/SLOT"},
  };
  for (const auto& [text, expected] : table) {
    const auto topic = ParseTopic("galatea", text);
    ASSERT_FALSE(topic) << text;
    EXPECT_NE(topic.error().text.find(expected), std::string::npos) << topic.error().text;
    EXPECT_NE(topic.error().text.find("'" + text + "'"), std::string::npos) << topic.error().text;
  }
}

TEST(MqttTopicsTest, ALongTopicIsShownWithoutHalfASign) {
  const std::string whole = "other/" + std::string(93, 'x');
  const auto topic = ParseTopic("galatea", whole + "\xE3\x81\x82");
  ASSERT_FALSE(topic);
  EXPECT_NE(topic.error().text.find("'" + whole + "'"), std::string::npos) << topic.error().text;
}

TEST(MqttTopicsTest, AModuleOfAnotherAgentIsNamedWithASlash) {
  EXPECT_EQ(SplitRemoteName("LOBBY/FSM").agent, "LOBBY");
  EXPECT_EQ(SplitRemoteName("LOBBY/FSM").module, "FSM");
  EXPECT_EQ(SplitRemoteName("FSM").agent, "");
  for (const char* name : {"LOBBY/#", "+/FSM", "LOBBY/", "/FSM", "LOBBY/FSM/Gaze", "LOBBY/$state"})
    EXPECT_EQ(SplitRemoteName(name).agent, "") << name;
}

}  // namespace
}  // namespace am::mqtt
