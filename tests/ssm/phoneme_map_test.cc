#include "ssm/voice/phoneme_map.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace {

using ssm::PhonemeMap;

std::string Mapped(std::string_view table, const vm::PhonemeList& list) {
  auto map = PhonemeMap::Parse(table, "t.txt");
  EXPECT_TRUE(map) << (map ? "" : map.error().text);
  return map ? vm::FormatPhonemesVoice(map->Map(list)) : "";
}

std::string ErrorOf(std::string_view table) {
  auto map = PhonemeMap::Parse(table, "t.txt");
  return map ? "" : map.error().text;
}

vm::Phoneme P(const char* name, int ms) { return {name, std::chrono::milliseconds(ms)}; }

constexpr std::string_view kTable =
    "# a table\nset a k ky cl N n ax pau\npause pau\ndouble cl\ndoubled n N\nvowels a pau\n"
    "A = a\nK = k\nY = +y\nL = -\nN = n\nD = a ax\n* = ax\n";

TEST(PhonemeMapTest, NamesAreReplacedAndTimesAreKept) {
  EXPECT_EQ(Mapped(kTable, {P("", 10), P("K", 50), P("A", 80)}), "pau[10] k[50] a[80]");
}

TEST(PhonemeMapTest, AMarkJoinsTheNameBeforeItWhereTheSetHasTheTwo) {
  EXPECT_EQ(Mapped(kTable, {P("K", 50), P("Y", 20), P("A", 80)}), "ky[70] a[80]");
  EXPECT_EQ(Mapped(kTable, {P("A", 80), P("Y", 20)}), "a[100]");
}

TEST(PhonemeMapTest, ADoubledConsonantIsAStopAndADoubledNIsANasal) {
  EXPECT_EQ(Mapped(kTable, {P("A", 80), P("K", 60), P("K", 50)}), "a[80] cl[60] k[50]");
  EXPECT_EQ(Mapped(kTable, {P("N", 60), P("N", 50)}), "N[60] n[50]");
  EXPECT_EQ(Mapped(kTable, {P("A", 60), P("A", 50)}), "a[60] a[50]");
}

TEST(PhonemeMapTest, DroppedNamesGiveTheirTimeToTheOneBefore) {
  EXPECT_EQ(Mapped(kTable, {P("A", 60), P("L", 40)}), "a[100]");
  EXPECT_EQ(Mapped(kTable, {P("L", 40), P("A", 60)}), "pau[40] a[60]");
}

TEST(PhonemeMapTest, OneNameMayBecomeTwoWhichShareItsTime) {
  EXPECT_EQ(Mapped(kTable, {P("D", 101)}), "a[50] ax[51]");
}

TEST(PhonemeMapTest, AccentsOfANameDoNotHideIt) {
  EXPECT_EQ(Mapped(kTable, {P("K\xCB\x90", 50), P("?", 10)}), "k[50] ax[10]");
}

TEST(PhonemeMapTest, BadTablesAreRefusedWithFileAndLine) {
  EXPECT_EQ(ErrorOf("set a pau\nQ = q\n* = a\n"), "t.txt:2: 'q' is not in the set");
  EXPECT_EQ(ErrorOf("set a pau\nwhat is this\n* = a\n"),
            "t.txt:2: found 'what is this', expected set, pause, double, vowels or NAME = ...");
  EXPECT_EQ(ErrorOf("set a pau\nA = a\nA = a\n* = a\n"), "t.txt:3: 'A' is there twice");
  EXPECT_EQ(ErrorOf("set a pau\npause p\n* = a\n"), "t.txt:2: 'p' is not in the set");
  EXPECT_EQ(ErrorOf("set a pau\nA = a\n"), "t.txt:2: there is no line '* = ...'");
  EXPECT_EQ(ErrorOf(""), "t.txt:0: there is no line 'set ...'");
}

TEST(PhonemeMapTest, OurOwnTablesAreRight) {
  for (const char* name : {"espeak_ipa.txt", "espeak_ja.txt"}) {
    std::ifstream file(std::string(GALATEA_SOURCE_DIR "/ssm/tables/") + name);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    auto map = PhonemeMap::Parse(text, name);
    EXPECT_TRUE(map) << map.error().text;
  }
}

}  // namespace
