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
  EXPECT_EQ(ssm::ReadNumber("0"), "ゼロ");
  EXPECT_EQ(ssm::ReadNumber("10"), "ジュー");
  EXPECT_EQ(ssm::ReadNumber("3600"), "サンゼンロッピャク");
  EXPECT_EQ(ssm::ReadNumber("8888"), "ハッセンハッピャクハチジューハチ");
  EXPECT_EQ(ssm::ReadNumber("12000"), "イチマンニセン");
  EXPECT_EQ(ssm::ReadNumber("100000000"), "イチオク");
  EXPECT_EQ(ssm::ReadNumber("1000000000000"), "イッチョー");
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

/// Texts and how they are read.
struct Spoken {
  std::string_view text, reading;
};

void ExpectAll(std::initializer_list<Spoken> table) {
  for (const Spoken& one : table) EXPECT_EQ(Read(one.text), one.reading) << one.text;
}

TEST(JapaneseNormalizerTest, DecimalsTakeThePlainCounter) {
  ExpectAll({{"1.5人", "イッテンゴニン"},         {"2.4人", "ニーテンヨンニン"},
             {"0.5本", "レイテンゴホン"},         {"1.3本", "イッテンサンホン"},
             {"3.1匹", "サンテンイチヒキ"},       {"1.5日", "イッテンゴニチ"},
             {"2.2日間", "ニーテンニニチカン"},   {"1.8分", "イッテンハチフン"},
             {"5.9時間", "ゴーテンキュージカン"}, {"8.4円", "ハッテンヨンエン"},
             {"20.0歳", "ニジュッテンゼロサイ"},  {"10.6個", "ジュッテンロクコ"},
             {"2.5つ", "ニーテンゴツ"},           {"12.5%", "ジューニーテンゴパーセント"},
             {"1.5km", "イッテンゴキロメートル"}, {"1.5metal", "イッテンゴエムイーティーエーエル"},
             {"1.5億円", "イッテンゴオクエン"},   {"2.3兆円", "ニーテンサンチョーエン"},
             {"3.5万人", "サンテンゴマンニン"},   {"-0.5度", "マイナスレイテンゴド"},
             {"100.25", "ヒャクテンニゴ"}});
  // Whatever the counter, it is the table's plain reading that follows.
  for (const char* counter :
       {"本", "匹", "杯", "泊", "分", "時", "日",     "月", "年", "人",   "歳", "個",
        "回", "階", "件", "軒", "冊", "足", "頭",     "点", "通", "着",   "円", "羽",
        "つ", "%",  "km", "cm", "kg", "度", "ページ", "秒", "才", "キロ", "枚"}) {
    static const ssm::Counters counters = OurCounters();
    for (const char* digit : {"1", "2", "3", "4", "6", "7", "8", "9"}) {
      EXPECT_EQ(Read(std::string("3.") + digit + counter),
                "サンテン" + ssm::ReadDigits(digit) + counters.Kana(counter));
    }
  }
}

TEST(JapaneseNormalizerTest, LargeNumbersAreExact) {
  ExpectAll(
      {{"1,300,000,000,000,000円", "センサンビャクチョーエン"},
       {"1300000000000000円", "センサンビャクチョーエン"},
       {"¥10,000,000,000,000,001", "イッケイイチエン"},
       {"100,000,000,000,000,000,000円", "イチガイエン"},
       {"123,456,789,012,345,678,901円",
        "イチガイニセンサンビャクヨンジューゴケイロクセンナナヒャクハチジューキューチョーヒャク"
        "ニジューサンオクヨンセンゴヒャクロクジューナナマンハッセンキューヒャクイチエン"},
       {"18,446,744,073,709,551,616",
        "センハッピャクヨンジューヨンケイロクセンナナヒャクヨンジューヨンチョーナナヒャクサンジュー"
        "ナナオクキューヒャクゴジューゴマンセンロッピャクジューロク"},
       {"999,999,999,999,999",
        "キューヒャクキュージューキューチョーキューセンキューヒャクキュー"
        "ジューキューオクキューセンキューヒャクキュージューキューマンキュー"
        "センキューヒャクキュージューキュー"},
       {"8兆円", "ハッチョーエン"},
       {"10兆円", "ジュッチョーエン"},
       {"11兆円", "ジューイッチョーエン"},
       {"6京円", "ロッケイエン"},
       {"100京", "ヒャッケイ"},
       {"1,300兆円", "センサンビャクチョーエン"},
       {"2億3千万人", "ニオクサンゼンマンニン"},
       {"3百万円", "サンビャクマンエン"},
       {"1兆2億3万4円", "イッチョーニオクサンマンヨエン"},
       {"12000万円", "イチオクニセンマンエン"},
       {"1億本", "イチオクホン"},
       {"10000本", "イチマンボン"},
       {"5万12345", "ゴマンイチマンニセンサンビャクヨンジューゴ"},
       {"第2京阪", "第ニ京阪"}});
  // One digit more than there are names for, and the number of a card.
  const std::string most(ssm::kMostNumberDigits, '9');
  EXPECT_TRUE(ssm::ReadNumber(most).starts_with("キューセンキューヒャクキュージューキューガイ"));
  EXPECT_EQ(ssm::ReadNumber("1" + most), ssm::ReadDigits("1" + most));
  EXPECT_EQ(Read("1" + most + "人"), ssm::ReadDigits("1" + most) + "ニン");
  EXPECT_EQ(Read("1234567812345678"), ssm::ReadDigits("1234567812345678"));
}

TEST(JapaneseNormalizerTest, LeadingZerosAndWideSignsAreRead) {
  ExpectAll({{"007", "ゼロゼロナナ"},
             {"2026年04月09日", "ニセンニジューロクネンシガツココノカ"},
             {"08時05分", "ハチジゴフン"},
             {"001番", "ゼロゼロイチバン"},
             {"007.50", "ゼロゼロナナテンゴゼロ"},
             {"0時", "レイジ"},
             {"0:05", "レイジゴフン"},
             {"0", "ゼロ"},
             {"１．５人", "イッテンゴニン"},
             {"１，３００円", "センサンビャクエン"},
             {"￥１，３００", "センサンビャクエン"},
             {"１４：３０", "ジューヨジサンジュップン"},
             {"３，４，５", "サン，ヨン，ゴ"},
             {"1234,567", "センニヒャクサンジューヨン,ゴヒャクロクジューナナ"}});
}

TEST(JapaneseNormalizerTest, MinusIsHeardAndHyphensAreNot) {
  ExpectAll({{"−5度", "マイナスゴド"},
             {"－５度", "マイナスゴド"},
             {"気温は-5度", "気温はマイナスゴド"},
             {"(-3)", "(マイナスサン)"},
             {"-1,000円", "マイナスセンエン"},
             {"-¥500", "マイナスゴヒャクエン"},
             {"¥-500", "マイナスゴヒャクエン"},
             {"F-16", "エフ-ジューロク"},
             {"コロナ-19", "コロナ-ジューキュー"},
             {"10-3", "ジューマイナスサン"},
             {"10:00-12:30", "ジュージカラジューニジサンジュップン"},
             {"2時〜5時", "ニジカラゴジ"},
             {"14:30~15:45", "ジューヨジサンジュップンカラジューゴジヨンジューゴフン"}});
}

TEST(JapaneseNormalizerTest, FractionsTimesAndMoneyAreRead) {
  ExpectAll(
      {{"3分の2", "サンブンノニ"},
       {"２分の１個", "ニブンノイチコ"},
       {"3分の1人", "サンブンノイチニン"},
       {"1000分の1秒", "センブンノイチビョー"},
       {"3分の休み", "サンプンの休み"},
       {"1/2個", "ニブンノイチコ"},
       {"3/4杯", "ヨンブンノサンハイ"},
       {"1/2", "イチガツフツカ"},
       {"11/21日", "ジューイチガツニジューイチニチ"},
       {"1/2番線", "イチ/ニバンセン"},
       {"2026.11.21", "ニセンニジューロクネンジューイチガツニジューイチニチ"},
       {"2,026年", "ニセンニジューロクネン"},
       {"2004年", "ニセンヨネン"},
       {"0.5年", "レイテンゴネン"},
       {"192.168.0.1", "ヒャクキュージューニーテンヒャクロクジューハッテンゼロテンイチ"},
       {"1.10.3", "イッテンジュッテンサン"},
       {"1:23.45", "イチ:ニジューサンテンヨンゴ"},
       {"1:02:03.5", "イチジニフンサンテンゴビョー"},
       {"$1.50", "イッテンゴゼロドル"},
       {"¥1.5億", "イッテンゴオクエン"},
       {"¥3万", "サンマンエン"},
       {"¥1,234.5", "センニヒャクサンジューヨンテンゴエン"},
       {"1,234.5円", "センニヒャクサンジューヨンテンゴエン"},
       {"99/100000000000000000001",
        "キュージューキュー/イチゼロゼロゼロゼロゼロゼロゼロゼロゼロゼロゼロゼロゼロゼロゼロゼロ"
        "ゼロゼロゼロイチ"}});
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
