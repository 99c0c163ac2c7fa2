#include "vm_protocol/core/utf8.h"

#include <gtest/gtest.h>

#include "vm_protocol/core/nearest_word.h"

namespace vm {
namespace {

TEST(Utf8Test, EverySignIsReadAsItWasWritten) {
  for (const char32_t sign : {U'a', U'\u00e9', U'あ', U'\U0001F600', U'\U0010FFFF', U'\uE000'}) {
    std::string text;
    AppendUtf8(text, sign);
    const auto read = DecodeUtf8(text, 0);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->value, sign);
    EXPECT_EQ(read->length, text.size());
  }
  for (const auto* bad : {"", "\x80", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe3\x81"})
    EXPECT_FALSE(DecodeUtf8(bad, 0)) << bad;
}

TEST(Utf8Test, ATextIsItsSigns) {
  const std::string text = "aé あ\U0001F600";
  EXPECT_EQ(SignsOf(text), U"aé あ\U0001F600");
  EXPECT_EQ(Utf8Of(SignsOf(text)), text);
  EXPECT_EQ(SignsOf("\xe3\x81z\xff"), U"\uFFFD\uFFFDz\uFFFD");
  EXPECT_EQ(SignAt("あ", 0).length, 3u);
  for (const std::size_t at : {1u, 3u}) {
    EXPECT_EQ(SignAt("あ", at).value, U'\uFFFD') << "within a sign, and at the end";
    EXPECT_EQ(SignAt("あ", at).length, 1u);
  }
  EXPECT_TRUE(BeginsSign('a') && BeginsSign("あ"[0]));
  EXPECT_FALSE(BeginsSign('\x80') || BeginsSign('\xbf'));
}

TEST(Utf8Test, ATextIsCutBetweenSigns) {
  EXPECT_EQ(CutUtf8("aあい", 6), "aあ");
  EXPECT_EQ(CutUtf8("aあい", 4), "aあ");
  EXPECT_EQ(CutUtf8("aあい", 3), "a");
  EXPECT_EQ(CutUtf8("あ", 2), "");
  EXPECT_EQ(CutUtf8("あ", 3), "あ");
}

TEST(Utf8Test, WhatATerminalWouldObeyIsNotShown) {
  EXPECT_EQ(ShownUtf8("a\x1b[2J\rb\n"), "a [2J b ");
  EXPECT_EQ(ShownUtf8("\xc2\x9b"), " ") << "the one-byte form of ESC [";
  EXPECT_EQ(ShownUtf8("\xffあ\xe3\x81"), "\xef\xbf\xbdあ\xef\xbf\xbd\xef\xbf\xbd");
}

TEST(NearestWordTest, FindsWhatWasMeant) {
  const std::vector<std::string> known{"MERRY", "SAD", "HeadRotAbs.1", "Go"};
  EXPECT_EQ(NearestWord("MERY", known), "MERRY");
  EXPECT_EQ(NearestWord("mreyr", known), "MERRY");
  EXPECT_EQ(NearestWord("HeadRot", known), "HeadRotAbs.1");
  EXPECT_EQ(NearestWord("x", known), "") << "a word of one letter is not a mistyped one";
  EXPECT_EQ(NearestWord("", known), "");
  EXPECT_EQ(NearestWord(std::string(100'000, 'M'), known), "");
}

}  // namespace
}  // namespace vm
