#include "chat/rules/rules.h"

#include <gtest/gtest.h>

#include <string>

#include "chat/tables/tables.h"

namespace chat {
namespace {

std::tm Afternoon() {
  std::tm now{};
  now.tm_hour = 14;
  now.tm_min = 5;
  now.tm_mon = 10;
  now.tm_mday = 25;
  now.tm_wday = 3;
  return now;
}

class RulesTest : public testing::Test {
 protected:
  std::string En(const std::string& heard) {
    return english_.Answer(heard, "Galatea", Afternoon());
  }
  std::string Ja(const std::string& heard) {
    return japanese_.Answer(heard, "Galatea", Afternoon());
  }
  Rules english_ = *Rules::Parse("rules_en.txt", tables::RulesEnglish());
  Rules japanese_ = *Rules::Parse("rules_ja.txt", tables::RulesJapanese());
};

TEST_F(RulesTest, SmallTalkIsAnswered) {
  EXPECT_EQ(En("Hello!"), "[happy 90] Hello! I am Galatea. How are you today?");
  EXPECT_EQ(En("What time is it?"), "It is 2:05 p.m.");
  EXPECT_EQ(En("what day is it today"), "Today is Wednesday, November 25.");
  EXPECT_TRUE(En("What can you do?").contains("listen, speak"));
  EXPECT_TRUE(En("I'm not feeling very happy, good night").contains("Goodbye"));
}

TEST_F(RulesTest, NamesAreRemembered) {
  EXPECT_TRUE(En("What's my name?").contains("not told me"));
  EXPECT_EQ(En("Hi. My name is bob."),
            "[happy 80] Nice to meet you, Bob! What shall we talk about?");
  EXPECT_EQ(En("what is my name?"), "[happy] You are Bob. I remember you.");
  english_.Forget();
  EXPECT_TRUE(En("What's my name?").contains("not told me"));
  EXPECT_TRUE(Ja("私の名前は太郎です。").contains("太郎さん"));
  EXPECT_TRUE(Ja("私の名前は？").contains("太郎さん"));
}

TEST_F(RulesTest, MineAndYoursChangePlaces) {
  EXPECT_EQ(En("I want my sister to see you"),
            "[nod] What would it mean to you to get your sister to see me?");
  EXPECT_EQ(En("You are like my mother"),
            "[happy 40] What makes you think that I am like your mother?");
}

TEST_F(RulesTest, AnswersTakeTurns) {
  const std::string first = En("bla bla");
  EXPECT_NE(En("bla bla"), first);
}

TEST_F(RulesTest, JapaneseIsMatchedSignBySign) {
  EXPECT_EQ(Ja("今何時ですか？"), "今は14時5分です。");
  EXPECT_TRUE(Ja("今日はとても悲しいです。").contains("大変ですね"));
  EXPECT_TRUE(Ja("りんごが好きです").contains("りんご"));
}

TEST_F(RulesTest, AnythingIsAnswered) {
  std::string many;
  for (int i = 0; i < 5000; ++i) many += "a * b (c) $1 [happy] ";
  for (const std::string& text : {std::string(""), std::string("..."), std::string("\xFF\xFE"),
                                  std::string("$name $1"), many}) {
    EXPECT_FALSE(En(text).empty());
    EXPECT_FALSE(Ja(text).empty());
  }
}

TEST(RulesTableTest, FaultsNameFileAndLine) {
  for (const char* const wrong : {"say without hear", "hear x\nsay", "bark x", "reflect one"}) {
    const auto rules = Rules::Parse("my.txt", std::string("# head\n") + wrong);
    ASSERT_FALSE(rules) << wrong;
    EXPECT_TRUE(rules.error().text.starts_with("my.txt:")) << rules.error().text;
  }
  EXPECT_FALSE(Rules::Parse("my.txt", "hear x"));
}

}  // namespace
}  // namespace chat
