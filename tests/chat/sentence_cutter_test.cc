#include "chat/text/sentence_cutter.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "chat/tables/tables.h"

namespace chat {
namespace {

using Texts = std::vector<std::string>;

const Abbreviations& ShippedAbbreviations() {
  static const Abbreviations abbreviations = ParseAbbreviations(tables::Abbreviations());
  return abbreviations;
}

/// Fed in pieces of so many bytes.
Texts Cut(const std::string& text, std::size_t piece) {
  SentenceCutter cutter(ShippedAbbreviations());
  Texts texts;
  const auto take = [&texts](std::vector<Sentence> sentences) {
    for (Sentence& sentence : sentences) texts.push_back(std::move(sentence.text));
  };
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = std::min(at + piece, text.size());
    while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
    cutter.Feed(text.substr(at, end - at));
    take(cutter.Take());
    at = end;
  }
  take(cutter.Flush());
  return texts;
}

void ExpectCut(const std::string& text, const Texts& expected) {
  for (const std::size_t piece : {std::size_t{1}, std::size_t{3}, std::size_t{7}, text.size() + 1})
    EXPECT_EQ(Cut(text, piece), expected) << text << " in pieces of " << piece;
}

TEST(SentenceCutterTest, EnglishIsCutAfterStopsBeforeWhatMayBeginASentence) {
  ExpectCut("Hello there. How are you? Fine!", {"Hello there.", "How are you?", "Fine!"});
  ExpectCut("Really?! Yes... Well.", {"Really?!", "Yes...", "Well."});
  ExpectCut("Yes... maybe tomorrow.", {"Yes... maybe tomorrow."});
  ExpectCut("So do I. Then we agree.", {"So do I.", "Then we agree."});
  ExpectCut("No. I do not think so.", {"No.", "I do not think so."});
}

TEST(SentenceCutterTest, AbbreviationsInitialsAndNumbersAreNoEnds) {
  ExpectCut("Dr. Smith met J. S. Bach, e.g. at 3.14 p.m. today. Good.",
            {"Dr. Smith met J. S. Bach, e.g. at 3.14 p.m. today.", "Good."});
  ExpectCut("See No. 5 and Fig. 7. Done.", {"See No. 5 and Fig. 7.", "Done."});
  ExpectCut("1. Take an egg. 2. Boil it.", {"1. Take an egg.", "2. Boil it."});
  ExpectCut("It costs $3.50. See example.com for more. Bye.",
            {"It costs $3.50.", "See example.com for more.", "Bye."});
}

TEST(SentenceCutterTest, ClosingQuotesBelongToWhatTheyClose) {
  ExpectCut("He said \"Stop.\" Then he left.", {"He said \"Stop.\"", "Then he left."});
  ExpectCut("\"Really?\" she said. (Yes.) Good.", {"\"Really?\" she said.", "(Yes.)", "Good."});
}

TEST(SentenceCutterTest, JapaneseIsCutOutsideOfItsQuotes) {
  ExpectCut("こんにちは。お元気ですか？はい！", {"こんにちは。", "お元気ですか？", "はい！"});
  ExpectCut("彼は「はい。そうです。」と言いました。次です。",
            {"彼は「はい。そうです。」と言いました。", "次です。"});
  ExpectCut("「はい。」彼は笑った。", {"「はい。」", "彼は笑った。"});
  ExpectCut("Hello!元気ですか。", {"Hello!", "元気ですか。"});
}

TEST(SentenceCutterTest, MarkdownPicturesAndControlsAreLeftOut) {
  ExpectCut("# Title\n\n- **One** item\n* `two`\n", {"Title", "One item", "two"});
  ExpectCut("Nice \xF0\x9F\x98\x80! 3 < 4.\x01", {"Nice !", "3 4."});
  ExpectCut("-5 degrees.", {"-5 degrees."});
}

TEST(SentenceCutterTest, WhatHasNoEndIsCutAtACommaABlankOrASign) {
  std::string words;
  while (words.size() < 1500) words += "word ";
  for (const std::string& text : {words, words + ", " + words, std::string(3000, 'x')}) {
    std::string again;
    for (const std::string& piece : Cut(text, 5)) {
      EXPECT_LE(piece.size(), SentenceCutter::kMaxSentenceBytes);
      again += piece;
    }
    std::erase(again, ' ');
    std::string all = text;
    std::erase(all, ' ');
    EXPECT_EQ(again, all);
  }
}

TEST(SentenceCutterTest, TheEndIsSeenBeforeAnythingFollows) {
  const auto would_end = [](const std::string& text) {
    SentenceCutter cutter(ShippedAbbreviations());
    cutter.Feed(text);
    cutter.Take();
    return cutter.WouldEnd();
  };
  EXPECT_TRUE(would_end("Hello."));
  EXPECT_TRUE(would_end("Hello. \"Yes!\""));
  EXPECT_TRUE(would_end("はい。"));
  EXPECT_FALSE(would_end("Hello Dr."));
  EXPECT_FALSE(would_end("Hello"));
  EXPECT_FALSE(would_end(""));
}

TEST(SentenceCutterTest, MarksStandWhereTheyWereGiven) {
  SentenceCutter cutter(ShippedAbbreviations());
  const auto cue = [](const char* value) { return Cue{vm::To("FSM", vm::Set("X", value))}; };
  cutter.Mark(cue("before"));
  cutter.Feed("Hello ");
  cutter.Mark(cue("within"));
  cutter.Feed("you.");
  cutter.Mark(cue("next"));
  cutter.Feed(" Good. ");
  cutter.Mark(cue("last"));
  const auto sentences = cutter.Flush();
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_EQ(sentences[0].before, std::vector<Cue>{cue("before")});
  ASSERT_EQ(sentences[0].within.size(), 1u);
  EXPECT_EQ(sentences[0].within[0].at, 6u);
  EXPECT_EQ(sentences[1].before, std::vector<Cue>{cue("next")});
  EXPECT_EQ(sentences[2].text, "");
  EXPECT_EQ(sentences[2].before, std::vector<Cue>{cue("last")});
}

TEST(SentenceCutterTest, AFloodOfMarksIsCut) {
  SentenceCutter cutter(ShippedAbbreviations());
  for (int i = 0; i < 10'000; ++i) cutter.Mark(Cue{vm::To("FSM", vm::Set("X", "1"))});
  EXPECT_EQ(cutter.Flush().at(0).before.size(), SentenceCutter::kMaxMarks);
}

TEST(SentenceCutterTest, OnlyWordsCanBeSpoken) {
  EXPECT_TRUE((Sentence{"a.", {}, {}}).HasWords());
  EXPECT_TRUE((Sentence{"。３", {}, {}}).HasWords());
  EXPECT_TRUE((Sentence{"あ", {}, {}}).HasWords());
  EXPECT_FALSE((Sentence{"...!?", {}, {}}).HasWords());
  EXPECT_FALSE((Sentence{"「…。」", {}, {}}).HasWords());
}

}  // namespace
}  // namespace chat
