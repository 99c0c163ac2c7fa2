#include "chat/app/settings.h"

#include <gtest/gtest.h>

namespace chat {
namespace {

TEST(SettingsTest, EveryKeyIsRead) {
  Settings settings;
  ASSERT_TRUE(ReadSettings("c.json",
                           R"({"url": "http://x", "model": "m", "key_file": "k", "persona": "p",
                               // a comment
                               "prompt_file": "/p.txt", "allow_set": ["@FSM Mask"], "listen": false,
                               "rules_files": ["r.txt"], "body": {"temperature": 0.5},
                               "limits": {"tokens": 100, "history_turns": 3}})",
                           "/etc", settings));
  EXPECT_EQ(settings.key_file, "/etc/k");
  EXPECT_EQ(settings.prompt_file, "/p.txt");
  EXPECT_EQ(settings.rules_files, std::vector<std::string>{"/etc/r.txt"});
  EXPECT_EQ(settings.body, R"({"temperature":0.5})");
  EXPECT_FALSE(settings.listen);
  EXPECT_EQ(settings.limits.size(), 2u);
}

TEST(SettingsTest, FaultsNameTheFileAndTheKey) {
  for (const char* const wrong :
       {"5", "{\"key\": \"sk\"}", "{\"model\": 5}", "{\"limits\": {\"x\": 1}}",
        "{\"allow_set\": \"@FSM Mask\"}", "{\"body\": []}"}) {
    Settings settings;
    const auto read = ReadSettings("c.json", wrong, "", settings);
    ASSERT_FALSE(read) << wrong;
    EXPECT_TRUE(read.error().text.starts_with("c.json: ")) << read.error().text;
  }
}

TEST(SettingsTest, TheCommandLineSaysMore) {
  Settings base, given;
  base.url = "http://a";
  base.model = "m";
  given.url = "http://b";
  given.listen = false;
  const Settings both = Over(base, given);
  EXPECT_EQ(both.url, "http://b");
  EXPECT_EQ(both.model, "m");
  EXPECT_FALSE(both.listen);
}

}  // namespace
}  // namespace chat
