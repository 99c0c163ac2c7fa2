#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "ssm/japanese/kana.h"
#include "ssm/japanese/normalizer.h"
#ifdef SSM_HAS_MECAB
#include "ssm/japanese/reader.h"
#endif

namespace {

ssm::Counters OurCounters() {
  std::ifstream file(GALATEA_SOURCE_DIR "/ssm/tables/ja_counters.txt");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  auto counters = ssm::Counters::Parse(text, "ja_counters.txt");
  EXPECT_TRUE(counters) << counters.error().text;
  return std::move(*counters);
}

/// The text with the parts that got a reading replaced by it.
std::string Read(std::string_view text) {
  static const ssm::Counters counters = OurCounters();
  std::string all;
  for (const auto& part : ssm::NormalizeJapanese(text, counters)) {
    all += part.reading.empty() ? part.text : part.reading;
  }
  return all;
}

TEST(JapaneseNumbersTest, AreReadWithTheirSoundChanges) {
  EXPECT_EQ(ssm::ReadNumber(0), "ゼロ");
  EXPECT_EQ(ssm::ReadNumber(10), "ジュー");
  EXPECT_EQ(ssm::ReadNumber(3600), "サンゼンロッピャク");
  EXPECT_EQ(ssm::ReadNumber(8888), "ハッセンハッピャクハチジューハチ");
  EXPECT_EQ(ssm::ReadNumber(12'000), "イチマンニセン");
  EXPECT_EQ(ssm::ReadNumber(100'000'000), "イチオク");
  EXPECT_EQ(ssm::ReadNumber(1'000'000'000'000), "イッチョー");
}

TEST(JapaneseNormalizerTest, CountersChangeTheNumberAndThemselves) {
  EXPECT_EQ(Read("3本"), "サンボン");
  EXPECT_EQ(Read("10本"), "ジュッポン");
  EXPECT_EQ(Read("21本"), "ニジューイッポン");
  EXPECT_EQ(Read("300本"), "サンビャッポン");
  EXPECT_EQ(Read("1人"), "ヒトリ");
  EXPECT_EQ(Read("4人"), "ヨニン");
  EXPECT_EQ(Read("11人"), "ジューイチニン");
  EXPECT_EQ(Read("20歳"), "ハタチ");
  EXPECT_EQ(Read("3つ"), "ミッツ");
  EXPECT_EQ(Read("50%"), "ゴジュッパーセント");
}

TEST(JapaneseNormalizerTest, DatesAndTimesAreRead) {
  EXPECT_EQ(Read("3月15日"), "サンガツジューゴニチ");
  EXPECT_EQ(Read("4月1日"), "シガツツイタチ");
  EXPECT_EQ(Read("9月20日"), "クガツハツカ");
  EXPECT_EQ(Read("2026/11/21"), "ニセンニジューロクネンジューイチガツニジューイチニチ");
  EXPECT_EQ(Read("2026-04-09"), "ニセンニジューロクネンシガツココノカ");
  EXPECT_EQ(Read("14:30"), "ジューヨジサンジュップン");
  EXPECT_EQ(Read("7:00"), "シチジ");
  EXPECT_EQ(Read("午後2時"), "午後ニジ");
}

TEST(JapaneseNormalizerTest, OtherNumbersAreRead) {
  EXPECT_EQ(Read("1,234円"), "センニヒャクサンジューヨエン");
  EXPECT_EQ(Read("¥500"), "ゴヒャクエン");
  EXPECT_EQ(Read("3.14"), "サンテンイチヨン");
  EXPECT_EQ(Read("-5"), "マイナスゴ");
  EXPECT_EQ(Read("3万5千円"), "サンマンゴセンエン");
  EXPECT_EQ(Read("03-1234-5678"), "ゼロサンノイチニサンヨンノゴロクナナハチ");
  EXPECT_EQ(Read("３個"), "サンコ");
  EXPECT_EQ(Read("TVは5km"), "ティーブイはゴキロメートル");
}

TEST(JapaneseNormalizerTest, WhatIsNoDateOrTimeIsNotReadAsOne) {
  EXPECT_EQ(Read("25:99"), "ニジューゴ:キュージューキュー");
  EXPECT_EQ(Read("13/45"), "ジューサン/ヨンジューゴ");
  EXPECT_EQ(Read(std::string(200, '9')).substr(0, 6), "キュ");
}

TEST(JapaneseNormalizerTest, BadTablesAreRefusedWithFileAndLine) {
  auto bad = ssm::Counters::Parse("本 ホン\n匹\n", "c.txt");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().text, "c.txt:2: expected COUNTER KANA [N=READING...]");
  bad = ssm::Counters::Parse("本 ホン x=イ\n", "c.txt");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().text, "c.txt:1: found 'x=イ', expected N=READING or N!=READING");
}

std::string Phonemes(std::string_view kana) {
  std::string all;
  for (const std::string& name : ssm::KanaToPhonemes(kana)) all += (all.empty() ? "" : " ") + name;
  return all;
}

TEST(KanaTest, BecomesTheOriginalsPhonemes) {
  EXPECT_EQ(Phonemes("キョー"), "ky o o");
  EXPECT_EQ(Phonemes("ガッコー"), "g a cl k o o");
  EXPECT_EQ(Phonemes("シャシン"), "sh a sh i N");
  EXPECT_EQ(Phonemes("ファ"), "f a");
  EXPECT_EQ(Phonemes("ティー"), "t i i");
  EXPECT_EQ(Phonemes("ウィ"), "w i");
  EXPECT_EQ(Phonemes("ちゅう"), "ch u u");
  EXPECT_EQ(Phonemes("ぎゃx"), "gy a");
}

#ifdef SSM_HAS_MECAB
TEST(JapaneseReaderTest, ParticlesAndNumbersAreReadAsTheyAreSpoken) {
  auto reader = ssm::JapaneseReader::Open("");
  if (!reader) GTEST_SKIP() << reader.error().text;
  std::string unread, all;
  for (const auto& word : (*reader)->Read("今日は3月15日です。", unread)) all += word.kana + " ";
  EXPECT_EQ(all, "キョー ワ サンガツ ジューゴニチ デス 。 ");
  EXPECT_EQ(unread, "");
}

TEST(JapaneseReaderTest, AFolderThatIsNoDictionaryIsNamed) {
  auto reader = ssm::JapaneseReader::Open("/nowhere");
  ASSERT_FALSE(reader);
  EXPECT_EQ(reader.error().text, "'/nowhere' is no MeCab dictionary");
}
#endif

}  // namespace
