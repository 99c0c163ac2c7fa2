#include "vm_protocol/core/phonemes.h"

#include <gtest/gtest.h>

namespace vm {
namespace {

using std::chrono::milliseconds;

PhonemeList List() {
  return {{"sil", milliseconds(10)}, {"k", milliseconds(60)}, {"o", milliseconds(75)}};
}

TEST(PhonemesTest, ReadsEverySpellingInUse) {
  for (const auto* text :
       {"sil[10] k[60] o[75]", "sil [10] k [60] o [75] ", "sil 10 k 60 o 75",
        " sil[ 10 ]\tk [60]  o 75", "sil[10] k[60] o[75] phoneme_end", "sil[10]k[60]o[75]"}) {
    const auto list = ParsePhonemes(text);
    ASSERT_TRUE(list) << text << ": " << list.error().text;
    EXPECT_EQ(*list, List()) << text;
  }
  EXPECT_EQ(ParsePhonemes(""), PhonemeList{});
}

TEST(PhonemesTest, WritesEachModulesSpelling) {
  EXPECT_EQ(FormatPhonemesVoice(List()), "sil[10] k[60] o[75]");
  EXPECT_EQ(FormatPhonemesFace(List()), "sil [10] k [60] o [75] ");
  EXPECT_EQ(FormatPhonemesPlain(List()), "sil 10 k 60 o 75");
}

TEST(PhonemesTest, RefusesBadListsWithTheirPlace) {
  const std::pair<const char*, std::size_t> kBad[] = {
      {"a", 2},       {"a x", 3},    {"a -5", 3},    {"a nan", 3},     {"a 1e9", 3},     {"a[5", 4},
      {"a 70000", 3}, {"a 10 b", 7}, {"[5] a 5", 1}, {"a 10 b] 4", 6}, {"a[5 6] b 5", 5}};
  for (const auto& [text, column] : kBad) {
    const auto list = ParsePhonemes(text);
    ASSERT_FALSE(list) << text;
    EXPECT_EQ(list.error().code, Errc::kBadValue);
    EXPECT_EQ(list.error().column, column) << text << ": " << list.error().text;
  }
}

TEST(PhonemesTest, TheSpokenPartEndsWithinThePhonemeReached) {
  EXPECT_EQ(TotalDuration(List()), milliseconds(145));
  EXPECT_EQ(SpokenPart(List(), milliseconds(0)), PhonemeList{});
  EXPECT_EQ(SpokenPart(List(), milliseconds(30)),
            (PhonemeList{{"sil", milliseconds(10)}, {"k", milliseconds(20)}}));
  EXPECT_EQ(SpokenPart(List(), milliseconds(1000)), List());
}

}  // namespace
}  // namespace vm
