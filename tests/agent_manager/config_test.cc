#include "agent_manager/config/config.h"

#include <gtest/gtest.h>

namespace am {
namespace {

vm::Result<Config> Parse(std::string_view text) { return ParseConfig(text, "am.json", "."); }

TEST(ConfigTest, ReadsEveryKey) {
  const auto config = Parse(R"({
    // comments are allowed
    "clock": "virtual", "log": "s.log", "listen": ["unix:/tmp/x"], "broadcast": ["DM"], "start_limit_ms": 500,
    "spin_us": 200,
    "modules": [
      {"name": "SSM", "command": ["ssm", "--sink", "null"], "cwd": "/", "env": {"A": "1"}, "restart": "always",
       "dialect": "original", "framing": "mmi", "encoding": "euc-jp"},
      {"name": "FSM", "command": "./fsm -C x"},
      {"name": "FAR", "connect": "tcp:h:1"}],
    "macros": {"Wave": [{"send": "to @FSM set FaceMot = NOD 1"}]}
  })");
  ASSERT_TRUE(config) << config.error().text;
  EXPECT_TRUE(config->virtual_clock);
  EXPECT_EQ(config->spin, std::chrono::microseconds(200));
  ASSERT_EQ(config->modules.size(), 3u);
  EXPECT_EQ(config->modules[0].command, (std::vector<std::string>{"ssm", "--sink", "null"}));
  EXPECT_EQ(config->modules[0].env, (std::vector<std::string>{"A=1"}));
  EXPECT_EQ(config->modules[0].restart.when, Restart::kAlways);
  EXPECT_EQ(config->modules[0].dialect, Dialect::kOriginal);
  EXPECT_EQ(config->modules[1].command.back(), "./fsm -C x");
  EXPECT_EQ(config->modules[2].connect, "tcp:h:1");
  EXPECT_TRUE(config->macros.contains("Wave"));
}

TEST(ConfigTest, AModuleMayTakeLongerToExitOnTheVirtualClockUnlessTheFileSaysHowLong) {
  const std::string modules =
      R"("modules": [{"name": "A", "command": "a"}, {"name": "B", "command": "b", "stop_within_ms": 50}])";
  const std::optional<std::chrono::milliseconds> none, minute = std::chrono::seconds(60);
  for (const auto& [clock, within] : {std::pair("real", none), std::pair("virtual", minute)}) {
    const auto config = Parse("{\"clock\": \"" + std::string(clock) + "\", " + modules + "}");
    ASSERT_TRUE(config) << config.error().text;
    EXPECT_EQ(config->modules[0].stop_within, within) << clock;
    EXPECT_EQ(config->modules[1].stop_within, std::chrono::milliseconds(50)) << clock;
  }
}

TEST(ConfigTest, WhatIsNestedTooDeeplyIsRefused) {
  const std::string open(1'000'000, '['), close(1'000'000, ']');
  for (const std::string& text :
       {"{\"macros\": {\"A\": " + open + close + "}}",
        "{\"limits\": {\"peers\": " + open + close + "}}",
        "{\"rules\": [{\"slot\": " + open + close + "}]}", open, "{\"log\": " + open}) {
    const auto config = Parse(text);
    ASSERT_FALSE(config);
    EXPECT_NE(config.error().text.find("am.json line 1: "), std::string::npos);
    EXPECT_NE(config.error().text.find("more than 64 brackets in each other"), std::string::npos)
        << config.error().text;
  }
}

TEST(ConfigTest, MacroFilesAreRelativeToTheConfigurationOrAbsolute) {
  const std::string folder = GALATEA_SOURCE_DIR "/examples/agents";
  for (const std::string& file : {std::string("../macros/greet.json"),
                                  std::string(GALATEA_SOURCE_DIR "/examples/macros/greet.json")}) {
    const auto config =
        ParseConfig("{\"macros\": {\"Greet\": \"" + file + "\"}}", "am.json", folder);
    ASSERT_TRUE(config) << config.error().text;
    EXPECT_NE(config->macros.at("Greet").find("\"steps\""), std::string::npos);
  }
}

TEST(ConfigTest, ReadsTheBroker) {
  const auto config = Parse(R"({"mqtt": {"broker": "tls:broker.example:8883", "agent": "HALL",
    "root": "museum/north", "user": "hall", "password_file": "p", "authority": "ca.pem",
    "modules": ["SSM", "F*"], "keep_alive_s": 30}})");
  ASSERT_TRUE(config) << config.error().text;
  EXPECT_EQ(config->mqtt.agent, "HALL");
  EXPECT_EQ(config->mqtt.root, "museum/north");
  EXPECT_EQ(config->mqtt.credentials.authority, "ca.pem");
  EXPECT_EQ(config->mqtt.modules, (std::vector<std::string>{"SSM", "F*"}));
  EXPECT_EQ(config->mqtt.keep_alive, std::chrono::seconds(30));
}

struct BadConfig {
  const char* text;
  const char* part;
};
class BadConfigTest : public testing::TestWithParam<BadConfig> {};

TEST_P(BadConfigTest, IsRefusedWithItsLineAndKey) {
  const auto config = Parse(GetParam().text);
  ASSERT_FALSE(config);
  EXPECT_NE(config.error().text.find(GetParam().part), std::string::npos) << config.error().text;
}

INSTANTIATE_TEST_SUITE_P(
    Texts, BadConfigTest,
    testing::Values(
        BadConfig{"{\n\"modules\": [\n}", "am.json line 3: not JSON"},
        BadConfig{R"({"mqtt": {"agent": "A"}})", "line 1: mqtt: broker is missing"},
        BadConfig{R"({"mqtt": {"broker": "tcp:localhost:1883"}})", "agent is missing"},
        BadConfig{R"({"mqtt": {"broker": "unix:/x", "agent": "A"}})", "expected tcp:HOST:PORT"},
        BadConfig{R"({"mqtt": {"broker": "tcp:localhost:1", "agent": "A/B"}})", "mqtt.agent: "},
        BadConfig{R"({"mqtt": {"broker": "tcp:localhost:1", "agent": "A", "root": "a/+"}})",
                  "mqtt.root: "},
        BadConfig{R"({"mqtt": {"broker": "tcp:192.0.2.1:1883", "agent": "A"}})",
                  "mqtt.broker: other machines reach this broker"},
        BadConfig{R"({"mqtt": {"broker": "tcp:localhost:1", "agent": "A", "key": "k"}})",
                  "certificate and key come together"},
        BadConfig{R"({"mqtt": {"broker": "tcp:localhost:1", "agent": "A", "password_file": "p"}})",
                  "user is missing"},
        BadConfig{R"({"clock": "virtual", "mqtt": {"broker": "tcp:localhost:1", "agent": "A"}})",
                  "mqtt: other agents do not follow a virtual clock"},
        BadConfig{R"({"spin_us": 20000})", "spin_us: found 20000, expected a whole number"},
        BadConfig{"{\"clock\": \"0123456789012345678901234567890123456789012345678901234\u3042 and "
                  "more\"}",
                  "78901234..., expected one of"},
        BadConfig{"[]", "line 1: (top): found [], expected an object"},
        BadConfig{"{\n\"clok\": 1}",
                  "am.json line 2: clok: unknown key, expected one of broadcast, clock"},
        BadConfig{"{\n\n\"clock\": \"fast\"}",
                  "am.json line 3: clock: found \"fast\", expected one of real, virtual"},
        BadConfig{"{\"listen\": [1]}", "listen[0]: found 1, expected a string"},
        BadConfig{"{\"modules\": [{\"name\": \"A\"}]}",
                  "modules[0]: expected either command or connect"},
        BadConfig{"{\"modules\": [{\"command\": \"x\"}]}", "modules[0].name: missing"},
        BadConfig{"{\"modules\": [{\"name\": \"a b\", \"command\": \"x\"}]}",
                  "modules[0].name: found \"a b\""},
        BadConfig{"{\"modules\": [\n{\"name\": \"A\", \"command\": \"x\"},\n{\"name\": "
                  "\"B\",\n\"command\": \"x\", \"restart\": 5}]}",
                  "am.json line 4: modules[1].restart: found 5, expected one of never, on-failure, "
                  "always"},
        BadConfig{"{\"modules\": [{\"name\": \"A\", \"command\": \"x\"}, {\"name\": \"A\", "
                  "\"command\": \"x\"}]}",
                  "modules[1].name: the name is taken twice"},
        BadConfig{"{\"clock\": \"real\",\n \"log\": \"a\",\n \"clock\": \"real\"}",
                  "line 3: clock: this key is written twice"},
        BadConfig{"{\"modules\": [{\"name\": \"A\", \"command\": [\"x}\"], \"env\": {\"E\": "
                  "\"}\"}},\n// }\n"
                  "{\"name\": \"B\", \"command\": \"x\",\n\"cwd\": 5}]}",
                  "am.json line 4: modules[1].cwd: found 5"},
        BadConfig{"{\"macros\": {\"M\": \"/nonexistent.json\"}}", "macros.M: cannot read"}));

TEST(ConfigTest, NumbersBeyondAllAndBracketsInNamesAreFaultsLikeOthers) {
  const auto number = ParseConfig("{\n \"spin_us\": 57e572}", "am.json", ".");
  ASSERT_FALSE(number);
  EXPECT_NE(number.error().text.find("am.json line 2: not JSON"), std::string::npos)
      << number.error().text;
  const auto name = ParseConfig("{\"macros\": {\"a[b].c\": \"/no/such/file\"}}", "am.json", ".");
  ASSERT_FALSE(name);
  EXPECT_NE(name.error().text.find("/no/such/file"), std::string::npos) << name.error().text;
}

}  // namespace
}  // namespace am
