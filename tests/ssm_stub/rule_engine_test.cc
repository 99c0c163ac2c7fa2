#include "ssm_stub/rule_engine.h"

#include <gtest/gtest.h>

#include "ssm_stub/english_rules.h"
#include "ssm_stub/japanese_rules.h"
#include "ssm_stub/phoneme_table.h"
#include "vm_protocol/core/utf8.h"

namespace ssm_stub {
namespace {

std::string Join(const PhonemeNames& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}
std::string Kana(std::string_view text) { return Join(FromKana(vm::SignsOf(text))); }
std::string Romaji(std::string_view text) {
  const auto names = FromRomaji(vm::SignsOf(text));
  return names ? Join(*names) : "-";
}

ssm::SpeechPlan Plan(const std::string& text, double stretch = 1) {
  ssm::SpeechSpan span;
  span.text = text;
  span.stretch = stretch;
  const std::atomic<bool> cancelled{false};
  auto plan = MakeRuleEngine()->Plan({span}, cancelled);
  EXPECT_TRUE(plan);
  return *plan;
}
std::string Phonemes(const std::string& text) {
  return vm::FormatPhonemesVoice(Plan(text).phonemes);
}

TEST(KanaTest, EverySyllableOfTheTable) {
  EXPECT_EQ(Kana("あいうえお"), "a i u e o");
  EXPECT_EQ(Kana("かしつふじぢづを"), "k a sh i ts u f u j i j i z u o");
  EXPECT_EQ(Kana("ガギグゲゴ"), "g a g i g u g e g o");
  EXPECT_EQ(Kana("きゃしゅちょりゃぴょ"), "ky a sh u ch o ry a py o");
  EXPECT_EQ(Kana("がっこう"), "g a cl k o u");
  EXPECT_EQ(Kana("しんぶん"), "sh i N b u N");
  EXPECT_EQ(Kana("ガラテアー"), "g a r a t e a a");
}

TEST(KanaTest, SmallVowelsMakeForeignSyllables) {
  EXPECT_EQ(Kana("ファイル"), "f a i r u");
  EXPECT_EQ(Kana("パーティー"), "p a a t i i");
  EXPECT_EQ(Kana("ウィーン"), "w i i N");
  EXPECT_EQ(Kana("シェフ"), "sh e f u");
  EXPECT_EQ(Kana("ヴァイオリン"), "b a i o r i N");
  EXPECT_EQ(Kana("デュエット"), "dy u e cl t o");
}

TEST(KanaTest, LettersOutOfPlaceAreNoTrouble) {
  for (const char* text :
       {"ー", "っ", "ん", "ゃ", "ぁ", "ーー", "っゃ", "んー", "んぁ", "ヶ", "ヵ", "ゎ"}) {
    FromKana(vm::SignsOf(text));
  }
  EXPECT_EQ(Kana("ゃ"), "y a");
  EXPECT_EQ(Kana("ー"), "");
}

TEST(RomajiTest, HepburnAndKunreiAreRead) {
  EXPECT_EQ(Romaji("konnichiwa"), "k o N n i ch i w a");
  EXPECT_EQ(Romaji("Toukyou"), "t o u ky o u");
  EXPECT_EQ(Romaji("Tōkyō"), "t o o ky o o");
  EXPECT_EQ(Romaji("gakkou"), "g a cl k o u");
  EXPECT_EQ(Romaji("matcha"), "m a cl ch a");
  EXPECT_EQ(Romaji("shin'ei"), "sh i N e i");
  EXPECT_EQ(Romaji("tsuzuku"), "ts u z u k u");
  EXPECT_EQ(Romaji("situmon"), "sh i ts u m o N");
  EXPECT_EQ(Romaji("fujisan"), "f u j i s a N");
}

TEST(RomajiTest, OtherWordsAreNot) {
  for (const char* word : {"hello", "the", "strength", "queen", "l", "k", "xyz"}) {
    EXPECT_EQ(Romaji(word), "-") << word;
  }
}

TEST(EnglishTest, RulesAndWordListGiveKnownPronunciations) {
  const struct {
    const char* word;
    const char* phonemes;
  } cases[] = {{"hello", "hh ax l ow"},
               {"Galatea", "g ae l ax t iy ax"},
               {"name", "n ey m"},
               {"night", "n ay t"},
               {"ship", "sh ih p"},
               {"nation", "n ae sh ax n"},
               {"queen", "k w iy n"},
               {"little", "l ih t l"},
               {"happy", "hh ae p iy"},
               {"city", "s ih t iy"},
               {"phone", "f ow n"},
               {"sky", "s k iy"},
               {"don't", "d aa n t"},
               {"walked", "w ae l k d"},
               {"e", "iy"}};
  for (const auto& one : cases)
    EXPECT_EQ(Join(FromEnglishWord(one.word)), one.phonemes) << one.word;
}

TEST(EnglishTest, EveryWordGivesSomethingFromTheTable) {
  for (char a = 'a'; a <= 'z'; ++a) {
    for (char b = 'a'; b <= 'z'; ++b) {
      for (char c = 'a'; c <= 'z'; ++c) {
        const auto names = FromEnglishWord(std::string{a, b, c});
        ASSERT_FALSE(names.empty()) << a << b << c;
        for (const auto& name : names) ASSERT_FALSE(name.empty());
      }
    }
  }
}

TEST(RuleEngineTest, DurationsAreThoseOfTheTable) {
  EXPECT_EQ(Phonemes("はい。"), "sil[100] h[60] a[90] i[70] sil[500]");
  EXPECT_EQ(Phonemes("Hello."), "pau[100] hh[60] ax[60] l[70] ow[140] pau[500]");
  EXPECT_EQ(Phonemes("Hello, you"),
            "pau[100] hh[60] ax[60] l[70] ow[140] pau[200] y[50] uw[110] pau[100]");
  EXPECT_EQ(PhonemeLength("no such"), kOtherPhoneme);
}

TEST(RuleEngineTest, TheLanguageIsGuessedAsStated) {
  EXPECT_TRUE(Phonemes("konnichiwa").starts_with("sil"));
  EXPECT_TRUE(Phonemes("Ohayou gozaimasu!").starts_with("sil"));
  for (const char* english :
       {"I see you", "no", "Take the same one", "Hello", "a", "banana", "42"}) {
    EXPECT_TRUE(Phonemes(english).starts_with("pau")) << english;
  }
  // Latin words among kana: romaji if they can be, else English.
  EXPECT_EQ(Phonemes("これは sushi です"),
            "sil[100] k[60] o[80] r[30] e[80] h[60] a[90] s[90] u[70] sh[100] i[70] d[40] e[80] "
            "s[90] u[70] sil[100]");
  EXPECT_NE(Phonemes("これは test").find("t[50] eh[90] s[90] t[50]"), std::string::npos);
}

TEST(RuleEngineTest, DigitsAreNamedInTheTextsLanguage) {
  EXPECT_EQ(Phonemes("7"), "pau[100] s[90] eh[90] v[60] ax[60] n[50] pau[100]");
  EXPECT_EQ(Phonemes("３だ"), "sil[100] s[90] a[90] N[80] d[40] a[90] sil[100]");
  EXPECT_EQ(Phonemes("3.5").find("pau[400]"), std::string::npos);
}

TEST(RuleEngineTest, CharactersWithoutAReadingAreTwoMoraeAndNamed) {
  const auto plan = Plan("今日は");
  EXPECT_EQ(vm::FormatPhonemesVoice(plan.phonemes),
            "sil[100] a[90] u[70] a[90] u[70] h[60] a[90] sil[100]");
  EXPECT_NE(plan.unspoken.find("今日"), std::string::npos);
  EXPECT_EQ(Plan("Hello 😀 ★").unspoken, "");
}

TEST(RuleEngineTest, AnyBytesAreSurvived) {
  for (const std::string& text :
       {std::string("\xff\xfe\x80"), std::string("\xe3\x81"), std::string("a\0b", 3),
        std::string(8192, '\''), std::string(8192, 'a'), std::string("''' - '")}) {
    const auto plan = Plan(text);
    EXPECT_FALSE(plan.phonemes.empty());
  }
}

TEST(RuleEngineTest, StretchScalesEveryPhoneme) {
  const auto plain = Plan("Hello");
  const auto slow = Plan("Hello", 1.5);
  ASSERT_EQ(plain.phonemes.size(), slow.phonemes.size());
  EXPECT_EQ(slow.phonemes[1].duration.count(), 90);
  EXPECT_EQ(slow.phonemes[3].duration.count(), 105);
}

TEST(RuleEngineTest, WordsStandWhereTheirPhonemesDo) {
  const auto plan = Plan("Hello, you");
  ASSERT_EQ(plan.words.size(), 2u);
  EXPECT_EQ(plan.words[0], (ssm::WordTime{"Hello", ssm::Millis(100), ssm::Millis(430)}));
  EXPECT_EQ(plan.words[1], (ssm::WordTime{"you", ssm::Millis(630), ssm::Millis(790)}));
}

}  // namespace
}  // namespace ssm_stub
