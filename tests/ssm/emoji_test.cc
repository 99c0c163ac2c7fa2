// What is left of a text when its emoji are taken out.

#include "ssm/voice/emoji.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace {

TEST(EmojiTest, AreTakenOutAndWordsStayParted) {
  const std::pair<std::string, std::string> cases[] = {{"great😀job", "great job"},
                                                       {"I love it 😀!", "I love it!"},
                                                       {"one 😀 two", "one  two"},
                                                       {"日本😀語", "日本語"},
                                                       {"👩‍👩‍👧‍👦", ""},
                                                       {"👍🏽", ""},
                                                       {"🇯🇵🇩🇪", ""},
                                                       {"1️⃣ one", "1 one"},
                                                       {"hot ☕, sun ☀️.", "hot, sun."}};
  for (const auto& [text, left] : cases) EXPECT_EQ(ssm::WithoutEmoji(text), left) << text;
}

TEST(EmojiTest, WhatIsTextStays) {
  // The last two have joiners inside a word (Persian, Hindi).
  for (const char* text :
       {"", "plain 12#*", "Galatea™ © 2026", "〰 ㊗", "→ a", "می‌خواهم", "क्‍ष"}) {
    EXPECT_EQ(ssm::WithoutEmoji(text), text) << text;
  }
}

}  // namespace
