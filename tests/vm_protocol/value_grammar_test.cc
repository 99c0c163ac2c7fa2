#include "vm_protocol/core/value_grammar.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vm {
namespace {

using Strings = std::vector<std::string>;

std::string Items(std::string_view grammar, std::string_view value) {
  const auto items = ValueGrammar(grammar).Match(value);
  if (!items) return "! " + std::to_string(items.error().column) + " " + items.error().text;
  std::string text;
  for (const auto& item : *items) text += "[" + item.text + "]";
  return text;
}

TEST(ValueGrammarTest, WordsMatchInAnyCaseAndAreGivenAsDeclared) {
  EXPECT_EQ(Items("NOW | STOP", "stop"), "[STOP]");
  EXPECT_EQ(Items("NOW | STOP", " NOW "), "[NOW]");
  EXPECT_EQ(Items("NOW | STOP", "NOWX"),
            "! 1 found 'NOWX', expected NOW | STOP, did you mean 'NOW'?");
}

TEST(ValueGrammarTest, NumbersKeepTheirBounds) {
  EXPECT_EQ(Items("<number 0..200>", "12.5"), "[12.5]");
  EXPECT_EQ(Items("<number 0..>", "1e3"), "[1e3]");
  for (const auto* bad : {"-1", "201", "nan", "inf", "1e999", "0x10", "1,5", "", "--1"}) {
    EXPECT_EQ(Items("<number 0..200>", bad)[0], '!') << bad;
  }
  EXPECT_EQ(Items("<int 1..5>", "3"), "[3]");
  EXPECT_EQ(Items("<int 1..5>", "3.5")[0], '!');
}

TEST(ValueGrammarTest, SequencesNameTheWordThatDoesNotFit) {
  const auto* grammar = "(HAPPY | SAD) <int 1..5> <number 0..200> <ms> | NEUTRAL";
  EXPECT_EQ(Items(grammar, "HAPPY 1 100 0"), "[HAPPY][1][100][0]");
  EXPECT_EQ(Items(grammar, "NEUTRAL"), "[NEUTRAL]");
  EXPECT_EQ(Items(grammar, "HAPPY 1 1e9 0"), "! 9 found '1e9', expected " + std::string(grammar));
  EXPECT_EQ(Items(grammar, "HAPPY 1 100"),
            "! 12 found the end of the value, expected " + std::string(grammar));
  EXPECT_EQ(Items(grammar, "NEUTRAL 5"), "! 9 found '5', expected " + std::string(grammar));
}

TEST(ValueGrammarTest, OptionsAndRepeatsMayBeLeftOutOrGoOn) {
  EXPECT_EQ(Items("<word> [ <number> ]", "a"), "[a]");
  EXPECT_EQ(Items("<word> [ <number> ]", "a 5"), "[a][5]");
  EXPECT_EQ(Items("( <word> <number 0..2> )...", "12L 0.7 4 1"), "[12L][0.7][4][1]");
  EXPECT_EQ(Items("( <word> <number 0..2> )...", "12L 0.7 4")[0], '!');
  EXPECT_EQ(Items("( <word> <number 0..2> )... [ <ms> ]", "1 1 2 2 300"), "[1][1][2][2][300]");
  std::string many;
  for (int i = 0; i < 20000; ++i) many += "a ";
  EXPECT_EQ(Items("<word>...", many).size(), 60000u) << "a long list is neither slow nor deep";
}

TEST(ValueGrammarTest, TimesAreOneItemInEverySpelling) {
  EXPECT_EQ(Items("STOP | <time>", "+ 500"), "[+500]");
  EXPECT_EQ(Items("STOP | <time>", "+500"), "[+500]");
  EXPECT_EQ(Items("STOP | <time>", "Now"), "[NOW]");
  EXPECT_EQ(Items("STOP | <time>", "@12.5"), "[@12.5]");
  EXPECT_EQ(Items("STOP | <time>", "Stop"), "[STOP]");
  EXPECT_EQ(Items("STOP | <time>", "sometime")[0], '!');
}

TEST(ValueGrammarTest, QuotedWordsHoldBlanksAndJsonEscapes) {
  EXPECT_EQ(Items("<word> <word>", "\"a b\" c"), "[a b][c]");
  EXPECT_EQ(Items("<word>", R"("\u3042\ud83d\ude00\n\"")"), "[あ😀\n\"]");
  EXPECT_EQ(Items("<word>", "\"open")[0], '!');
  EXPECT_EQ(Items("<word>", R"("\ud800")")[0], '!');
  EXPECT_EQ(Items("<file>", "my picture.png "), "[my picture.png]");
  EXPECT_EQ(Items("<file>", "\"my picture.png\""), "[my picture.png]");
  EXPECT_EQ(Items("<file>", "")[0], '!');
}

TEST(ValueGrammarTest, TextIsTheRestOfTheLineAsItIs) {
  EXPECT_EQ(Items("<text>", "  a  b "), "[a  b ]");
  EXPECT_EQ(Items("<text>", ""), "[]");
  EXPECT_EQ(Items("HAPPY <text>", "happy a b"), "[HAPPY][a b]");
}

TEST(ValueGrammarTest, AMistypedWordIsGuessed) {
  const auto* grammar = "( MERRY | SAD ) <int 1..5>";
  EXPECT_EQ(Items(grammar, "MERY 1"),
            "! 1 found 'MERY', expected " + std::string(grammar) + ", did you mean 'MERRY'?");
  EXPECT_EQ(Items(grammar, "GREEN 1"), "! 1 found 'GREEN', expected " + std::string(grammar));
}

TEST(ValueGrammarTest, AGrammarFromOutsideIsRefusedWithItsPlace) {
  const std::pair<std::string, std::string> kBad[] = {
      {"", "column 1: value grammar: found the end, expected a word"},
      {"A |", "column 4: value grammar: found the end, expected a word"},
      {"<bogus>", "column 1: value grammar: found '<bogus>', expected <number>"},
      {"<int a..b>", "column 1: value grammar: found '<int a..b>', expected a range"},
      {"<int 5>", "column 1: value grammar: found '<int 5>', expected a range"},
      {"A [ B", "column 6: value grammar: found the end, expected ']'"},
      {"A )", "column 3: value grammar: found ')', expected the end"},
      {"<int", "column 1: value grammar: found '<int', expected '>'"},
      {"A; B", "column 2: value grammar"},
      {"A\n", "column 2: value grammar"},
      {"\xff", "column 1: value grammar"},
      {std::string(60'000, '('), "a value grammar of 60000 bytes"},
      {std::string(4'000, '('), "column 33: value grammar: found '(((("}};
  for (const auto& [text, error] : kBad) {
    const auto grammar = ValueGrammar::Parse(text);
    ASSERT_FALSE(grammar) << text;
    EXPECT_EQ(grammar.error().code, Errc::kBadValue);
    EXPECT_NE(FormatError(grammar.error()).find(error), std::string::npos)
        << FormatError(grammar.error());
  }
  EXPECT_TRUE(ValueGrammar::Parse(std::string(32, '(') + "A" + std::string(32, ')')));
  EXPECT_THROW(ValueGrammar("<bogus>"), std::logic_error);
}

TEST(ValueGrammarTest, AFilesNameIsMarkedWhereverItStands) {
  const auto grammar = ValueGrammar("STOP | <word> <file>");
  EXPECT_TRUE(grammar.has_file());
  const auto items = grammar.Match("png a b.png");
  ASSERT_TRUE(items);
  EXPECT_TRUE((*items)[0].files.empty());
  EXPECT_EQ((*items)[1].files, Strings{"a b.png"});
  EXPECT_EQ((*items)[1].text, "a b.png");
  EXPECT_FALSE(ValueGrammar("STOP | <text>").has_file());
}

TEST(ValueGrammarTest, EverySourceInAMarkupIsAFilesName) {
  const ValueGrammar grammar("NOW | <markup>");
  EXPECT_TRUE(grammar.has_file());
  EXPECT_TRUE(grammar.has_text());
  const auto files = [&](const char* text) {
    const auto items = grammar.Match(text);
    return items && items->size() == 1 && (*items)[0].text == text ? (*items)[0].files
                                                                   : Strings{"no match"};
  };
  EXPECT_EQ(files("src is a word, src = too"), Strings{});
  EXPECT_EQ(files("<speak>a<audio src=\"a.wav\"/> <audio\tx='1' src = '/b c.wav'>d</audio>"),
            (Strings{"a.wav", "/b c.wav"}));
  EXPECT_EQ(files("<audio src='&#47;etc'/><audio src=\"\"/>"), Strings{"markup:&#47;etc"});
  EXPECT_EQ(files("<audio src='a&amp;b&quot;.wav'/>"), Strings{"a&b\".wav"});
  EXPECT_EQ(files("<audio src\v=\f'/a'/><audio s\xEE\x80\x80rc='/b'/><a src=\xEE\x80\x81'/c'/>"),
            (Strings{"/a", "/b", "/c"}));
  EXPECT_EQ(files("<audio src='\xEE\x80\x82/abs'/>"), Strings{"/abs"});
  EXPECT_EQ(files("<audio src='never closed"), Strings{});
}

TEST(ValueGrammarTest, AnAmbiguousGrammarAndALongValueTakeBoundedTime) {
  std::string optional = "( ";
  for (int i = 0; i < 60; ++i) optional += "[ <word> ] ";
  const std::string value = std::string(30'000, 'a') + " " + std::string(30'000, 'b') + " c d";
  EXPECT_EQ(Items(optional + "x )...", value)[0], '!');
  EXPECT_EQ(Items("( ( ( <text> )... )... )... x", value)[0], '!');
  std::string long_grammar;
  for (int i = 0; i < 2'000; ++i) long_grammar += "a ";
  EXPECT_EQ(Items(long_grammar, long_grammar)[0], '!') << "deeper than the stack may grow";
}

}  // namespace
}  // namespace vm
