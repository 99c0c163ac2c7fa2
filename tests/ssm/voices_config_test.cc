#include "ssm/app/voices_config.h"

#include <gtest/gtest.h>

namespace {

vm::Result<ssm::VoicesConfig> Parse(const std::string& json) {
  return ssm::ParseVoicesConfig(
      json, {.folder = "/dir", .read_file = [](const std::string& path) -> vm::Result<std::string> {
               if (path == "/dir/good.txt") return "set a pau\nA = a\n* = a\n";
               if (path == "/dir/bad.txt") return "set a pau\nA = b\n* = a\n";
               return vm::Fail(vm::Errc::kUnavailable, "cannot read '" + path + "'");
             }});
}
std::string ErrorOf(const std::string& json) {
  auto config = Parse(json);
  return config ? "" : config.error().text;
}

TEST(VoicesConfigTest, VoicesAndLanguagesAreRead) {
  auto config = Parse(
      R"({"voices": [{"name": "bell", "engine": "command", "language": "fr", "female": true,
                      "argv": ["./bell", "{wav}"], "phonemes": "good.txt", "limit_ms": 500},
                     {"name": "tape", "engine": "recorded",
                      "recordings": [{"text": "Hello.", "wav": "h.wav"}]}],
          "languages": {"fr": "bell"}})");
  ASSERT_TRUE(config) << config.error().text;
  ASSERT_EQ(config->engines.size(), 2u);
  EXPECT_EQ(config->engines[0]->voices()[0].name, "bell");
  EXPECT_EQ(config->engines[0]->voices()[0].language, "fr");
  EXPECT_TRUE(config->engines[0]->voices()[0].female);
  EXPECT_EQ(config->languages.at("fr"), "bell");
}

TEST(VoicesConfigTest, MistakesNameTheVoiceAndTheKey) {
  EXPECT_EQ(ErrorOf("{"), "no JSON at byte 2");
  EXPECT_EQ(ErrorOf("[]"), "expected {\"voices\": [...]}");
  EXPECT_EQ(ErrorOf(R"({"voice": []})"),
            "found \"voice\", expected \"voices\": [...] or \"languages\": {...}");
  EXPECT_EQ(ErrorOf(R"({"voices": [3]})"), "voice 1: expected an object");
  EXPECT_EQ(
      ErrorOf(R"({"voices": [{"name": "x", "engine": "magic"}]})"),
      "voice 1 'x': \"engine\" is 'magic', expected open_jtalk, hts, http, command or recorded");
  EXPECT_EQ(ErrorOf(R"({"voices": [{"name": "x", "engine": "command"}]})"),
            "voice 1 'x': \"argv\" must be a list");
  EXPECT_EQ(
      ErrorOf(R"({"voices": [{"name": "x", "engine": "command", "argv": ["a"], "speed": 1}]})"),
      "voice 1 'x': unknown key \"speed\"");
  EXPECT_EQ(ErrorOf(R"({"voices": [{"name": "x", "engine": "command", "argv": ["a"],
                                    "limit_ms": 0}]})"),
            "voice 1 'x': \"limit_ms\" must be a whole number from 1 to 600000");
  EXPECT_EQ(ErrorOf(R"({"voices": [{"name": "x", "engine": "command", "argv": ["a"],
                                    "phonemes": "bad.txt"}]})"),
            "voice 1 'x': /dir/bad.txt:2: 'b' is not in the set");
  EXPECT_TRUE(ErrorOf(R"({"voices": [{"name": "x", "engine": "open_jtalk", "voice": "v"}]})")
                  .starts_with("voice 1 'x': cannot read voice file '/dir/v'"));
  EXPECT_EQ(ErrorOf(R"({"voices": [{"name": "x", "engine": "hts", "voice": "v",
                                    "emotions": {"BORED": "b"}}]})"),
            "voice 1 'x': \"emotions\" must be {EMOTION: FILE, ...} with HAPPY, ANGRY, DISGUSTED, "
            "SAD, SURPRISED or FEARED; found \"BORED\"");
  const auto http = [](const std::string& more) {
    return ErrorOf(R"({"voices": [{"name": "x", "engine": "http", "model": "m", "voice": "v")" +
                   more + "}]}");
  };
  EXPECT_EQ(http(""), "voice 1 'x': \"url\" must be a text");
  EXPECT_EQ(
      http(R"(, "url": "ftp://a")"),
      "voice 1 'x': 'ftp://a' is no address of a voice, expected http://HOST:PORT or https://HOST");
  EXPECT_EQ(http(R"(, "url": "http://a", "format": "opus")"),
            "voice 1 'x': \"format\" must be wav, pcm or mp3");
  EXPECT_EQ(http(R"(, "url": "http://a", "rate_hz": 10)"),
            "voice 1 'x': \"rate_hz\" must be a whole number from 8000 to 192000");
  EXPECT_TRUE(http(R"(, "url": "http://a", "key_file": "none")").contains("/dir/none"));
  EXPECT_EQ(http(R"(, "url": "http://a:1/v1/")"), "");
  EXPECT_TRUE(ErrorOf(R"({"voices": [{"name": "x", "engine": "hts", "voice": "v",
                                      "emotions": ["SAD"]}]})")
                  .starts_with("voice 1 'x': \"emotions\" must be {EMOTION: FILE"));
}

}  // namespace
