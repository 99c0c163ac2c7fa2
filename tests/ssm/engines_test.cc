// The engines that speak through other programs, with small shell scripts for programs.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <numbers>

#include "ssm/engines/command_engine.h"
#include "ssm/engines/engine_set.h"
#include "ssm/engines/espeak_engine.h"
#include "ssm/engines/language_runs.h"
#include "ssm/engines/open_jtalk_engine.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/voice/resample.h"
#include "ssm/voice/wav_file.h"
#include "tests/ssm/spoken.h"

namespace {

using ssm::Millis;
using ssm::SpeechSpan;
using ssm_test::kNever;
using ssm_test::Rms;
using ssm_test::Speak;

ssm::SpeechSpan Span(const std::string& text, const std::string& voice = "") {
  return {.text = text, .voice = voice};
}

std::vector<std::int16_t> Tone(double hz, std::size_t rate, std::size_t frames) {
  std::vector<std::int16_t> tone(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    const double angle =
        2 * std::numbers::pi * hz * static_cast<double>(i) / static_cast<double>(rate);
    tone[i] = static_cast<std::int16_t>(std::lround(10'000 * std::sin(angle)));
  }
  return tone;
}

TEST(ResampleTest, KeepsTonesAndDampsWhatTheNewRateCannotHold) {
  const auto kept = ssm::Resample(Tone(1000, 48'000, 48'000), 48'000, 16'000);
  EXPECT_EQ(kept.size(), 16'000u);
  EXPECT_NEAR(Rms(kept), 10'000 / std::numbers::sqrt2, 70);
  EXPECT_LT(Rms(ssm::Resample(Tone(10'000, 48'000, 48'000), 48'000, 16'000)), 40);
  const auto odd = ssm::Resample(Tone(440, 22'050, 22'050), 22'050, 16'000);
  EXPECT_EQ(odd.size(), 16'000u);
  EXPECT_NEAR(odd[1000], 10'000 * std::sin(2 * std::numbers::pi * 440 / 16), 60);
}

TEST(LanguageRunsTest, CutWhereTheScriptSaysSo) {
  using Runs = std::vector<ssm::LanguageRun>;
  EXPECT_EQ(ssm::SplitLanguages("Say こんにちは, please.", "en"),
            (Runs{{"en", "Say "}, {"ja", "こんにちは, "}, {"en", "please."}}));
  EXPECT_EQ(ssm::SplitLanguages("AIはHelloと言う", "ja"),
            (Runs{{"ja", "AIは"}, {"en", "Hello"}, {"ja", "と言う"}}));
  EXPECT_EQ(ssm::SplitLanguages("Привет мир", "en"), (Runs{{"ru", "Привет мир"}}));
  EXPECT_EQ(ssm::SplitLanguages("Привіт", "uk"), (Runs{{"uk", "Привіт"}}));
  EXPECT_EQ(ssm::SplitLanguages("12.30", "de"), (Runs{{"de", "12.30"}}));
  EXPECT_EQ(ssm::SplitLanguages("", "de"), Runs{});
}

TEST(LanguageRunsTest, IdeographsBeyondThoseOfJapaneseAreFound) {
  for (const char* chinese : {"你好，世界", "谢谢", "我们"}) {
    EXPECT_TRUE(ssm::FindIdeographs(chinese).beyond_japanese) << chinese;
    EXPECT_FALSE(ssm::FindIdeographs(chinese).kana) << chinese;
  }
  for (const char* japanese : {"東京都庁", "世界", "髙﨑", "今日は晴れです"}) {
    EXPECT_FALSE(ssm::FindIdeographs(japanese).beyond_japanese) << japanese;
    EXPECT_TRUE(ssm::FindIdeographs(japanese).any) << japanese;
  }
  EXPECT_TRUE(ssm::FindIdeographs("今日は").kana);
  EXPECT_FALSE(ssm::FindIdeographs("Hello, 12.").any);
}

TEST(SentencesTest, AreCutInEveryScriptAndSignsAloneAreNone) {
  using Sentences = std::vector<std::string>;
  EXPECT_EQ(ssm::SplitUtf8Sentences("一つ。二つ！three. Four?"),
            (Sentences{"一つ。", "二つ！", "three.", " Four?"}));
  EXPECT_EQ(ssm::SplitUtf8Sentences("Dr. Watson came at 9 a.m. on foot."),
            (Sentences{"Dr. Watson came at 9 a.m. on foot."}));
  EXPECT_EQ(ssm::SplitUtf8Sentences("3.14 is pi\n...\n"), (Sentences{"3.14 is pi\n"}));
  EXPECT_EQ(ssm::SplitUtf8Sentences("\x01 a\xFF b"), (Sentences{"  a b"}));
  for (const std::string& piece : ssm::SplitUtf8Sentences(std::string(5000, 'x'))) {
    EXPECT_LE(piece.size(), 500u);
  }
}

ssm::CommandOptions Shell(const std::string& script) {
  return {.name = "shell", .argv = {"sh", "-c", script}, .limit = Millis(5000)};
}

class CommandEngineTest : public testing::Test {
 protected:
  CommandEngineTest() {
    EXPECT_TRUE(ssm::WriteWav(folder_.File("tone.wav"), Tone(500, 16'000, 1600)));
  }
  vm::Result<ssm::SpeechPlan> Plan(const std::string& script, Millis limit = Millis(5000)) {
    auto options = Shell(script);
    options.limit = limit;
    auto engine = ssm::MakeCommandEngine(options);
    EXPECT_TRUE(engine);
    return (*engine)->Plan({Span("Hello there.")}, kNever);
  }
  std::string ErrorOf(const std::string& script) {
    auto plan = Plan(script);
    return plan ? "" : plan.error().text;
  }
  const ssm::TemporaryFolder folder_;
};

TEST_F(CommandEngineTest, SoundAndPhonemesOfAnyProgramArePlayed) {
  auto engine = ssm::MakeCommandEngine(
      Shell("cp " + folder_.File("tone.wav") + " {wav}; read x; echo 'h[20] e[30]'; echo 'o[50]'"));
  ASSERT_TRUE(engine);
  const auto [plan, sound] = Speak(**engine, {Span("Hello there.")});
  EXPECT_EQ(vm::FormatPhonemesVoice(plan.phonemes), "h[20] e[30] o[50]");
  ASSERT_EQ(plan.words.size(), 2u);
  EXPECT_EQ(plan.words[1].text, "there.");
  EXPECT_EQ(sound, Tone(500, 16'000, 1600));
}

TEST_F(CommandEngineTest, SoundOnStdoutWithLabelsInAFile) {
  const auto plan = Plan("cat " + folder_.File("tone.wav") + "; echo 'a[60]' > {labels}");
  ASSERT_TRUE(plan) << plan.error().text;
  EXPECT_EQ(vm::FormatPhonemesVoice(plan->phonemes), "a[60] pau[40]");
}

TEST_F(CommandEngineTest, WhatGoesWrongIsSaidInOneSentence) {
  EXPECT_EQ(ErrorOf("exit 3"), "program 'sh' ended with status 3");
  EXPECT_TRUE(ErrorOf("true").starts_with("program 'sh' gave no sound: "));
  EXPECT_EQ(ErrorOf("cp " + folder_.File("tone.wav") + " {wav}"),
            "program 'sh' gave no phonemes, expected name[ms] ...");
  EXPECT_TRUE(ErrorOf("cp " + folder_.File("tone.wav") + " {wav}; echo 'a[x]'")
                  .starts_with("phonemes of program 'sh': "));
  auto nothing = ssm::MakeCommandEngine({.name = "n"});
  ASSERT_FALSE(nothing);
  EXPECT_EQ(nothing.error().text, "voice 'n' names no program");
  auto missing = ssm::MakeCommandEngine({.name = "n", .argv = {"/nowhere/x"}});
  ASSERT_TRUE(missing);
  auto plan = (*missing)->Plan({Span("a")}, kNever);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, vm::Errc::kUnavailable);
}

TEST_F(CommandEngineTest, AProgramThatHangsIsKilledAtTheLimit) {
  auto plan = Plan("sleep 1000 & wait", Millis(100));
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, vm::Errc::kTimeout);
}

TEST_F(CommandEngineTest, ACancelledTextEndsTheProgram) {
  auto engine = ssm::MakeCommandEngine(Shell("sleep 1000"));
  const std::atomic<bool> cancelled{true};
  auto plan = (*engine)->Plan({Span("a")}, cancelled);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, vm::Errc::kStopped);
}

TEST(RecordedEngineTest, ARecordingWithItsPhonemesBesideItIsPlayed) {
  const ssm::TemporaryFolder folder;
  const std::string wav = folder.File("hello.wav");
  ASSERT_TRUE(ssm::WriteWav(wav, Tone(500, 16'000, 1600)));
  ASSERT_EQ(std::system(("echo 'phonemes: hh[40] ow[60]' > " + wav + ".info").c_str()), 0);
  auto engine = ssm::MakeRecordedEngine(
      {.name = "tape", .recordings = {{.text = "Hello, you!", .wav = wav}}});
  const auto plan = Speak(*engine, {Span("hello you")}).plan;
  EXPECT_EQ(vm::FormatPhonemesVoice(plan.phonemes), "hh[40] ow[60]");
  auto other = engine->Plan({Span("Good bye.")}, kNever);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().text, "voice 'tape' has no recording of 'Good bye.'");
}

TEST(OpenJtalkTest, ItsTraceGivesPhonemesAndWords) {
  auto trace = ssm::ParseOpenJtalkTrace(
      "[Text analysis result]\n今日,名詞,*,*,*,*,*,今日,キョウ,キョー,1/2,C3,-1\n"
      "は,助詞,*,*,*,*,*,は,ハ,ワ,0/1,x,1\n\n[Output label]\n"
      "0 2700000 x^x-sil+ky=o/A:\n2700000 3650000 x^x-ky+o=o/A:\n3650000 4250000 x^x-o+o=w/A:\n"
      "4250000 5250000 x^x-o+w=a/A:\n5250000 5754000 x^x-w+a=s/A:\n5754000 6550000 x^x-a+x=x/A:\n");
  ASSERT_TRUE(trace) << trace.error().text;
  const vm::PhonemeList phonemes = ssm::PhonemesOf(*trace, trace->ends);
  EXPECT_EQ(vm::FormatPhonemesVoice(phonemes), "sil[270] ky[95] o[60] o[100] w[50] a[80]");
  const auto words = ssm::WordsOf(*trace, phonemes);
  ASSERT_EQ(words.size(), 2u);
  EXPECT_EQ(words[1], (ssm::WordTime{"は", Millis(525), Millis(655)}));
  auto bad = ssm::ParseOpenJtalkTrace("[Output label]\n0 10 nonsense\n");
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().text,
            "trace of open_jtalk, line 2: found '0 10 nonsense', expected START END LABEL");
}

TEST(OpenJtalkTest, AFileThatIsNoVoiceIsRefused) {
  auto engine = ssm::MakeOpenJtalkEngine({.name = "x", .voice_file = "/bin/sh"});
  ASSERT_FALSE(engine);
  EXPECT_EQ(engine.error().text, "'/bin/sh' is no voice file, expected it to begin [GLOBAL]");
}

class EspeakTest : public testing::Test {
 protected:
  void SetUp() override {
    if (access(kHelper, X_OK) != 0)
      GTEST_SKIP()
          << "needs ssm_espeak, which is built where there is espeak-ng (Debian: libespeak-ng-dev)";
    engine_ = ssm::MakeEspeakEngine({.helper = kHelper});
  }
  static constexpr const char* kHelper = GALATEA_BIN_DIR "/ssm_espeak";
  std::unique_ptr<ssm::SpeechEngine> engine_;
};

TEST_F(EspeakTest, SpeaksOtherLanguagesWithFlitesPhonemes) {
  const auto [plan, sound] = Speak(*engine_, {Span("Guten Tag.", "espeak-de")});
  std::string names;
  for (const vm::Phoneme& phoneme : plan.phonemes) names += phoneme.name + " ";
  EXPECT_EQ(names, "pau g uw t ax n t aa k pau ");
  ASSERT_EQ(plan.words.size(), 2u);
  EXPECT_EQ(plan.words[1].text, "Tag");
  EXPECT_GT(Rms(sound), 500);
}

TEST_F(EspeakTest, RateStretchesTheTimes) {
  auto fast = Span("one two three four five", "espeak-en");
  auto slow = fast;
  fast.stretch = 0.6;
  slow.stretch = 1.5;
  const auto quick = vm::TotalDuration(Speak(*engine_, {fast}).plan.phonemes);
  const auto long_one = vm::TotalDuration(Speak(*engine_, {slow}).plan.phonemes);
  EXPECT_GT(long_one.count(), 1.7 * static_cast<double>(quick.count()));
}

TEST_F(EspeakTest, AHelperThatIsNotThereIsNamed) {
  auto engine = ssm::MakeEspeakEngine({.helper = "/nowhere/ssm_espeak"});
  auto plan = engine->Plan({Span("hello", "espeak-en")}, kNever);
  ASSERT_FALSE(plan);
  EXPECT_TRUE(plan.error().text.starts_with("program '/nowhere/ssm_espeak' cannot be started"));
}

TEST(EspeakHelperTest, ADeadOrSilentHelperIsAnErrorAndTheNextSentenceWorks) {
  auto dead = ssm::MakeEspeakEngine({.helper = "true"});
  auto plan = dead->Plan({Span("hello", "espeak-en")}, kNever);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, vm::Errc::kUnavailable);
  auto silent = ssm::MakeEspeakEngine(
      {.helper = GALATEA_SOURCE_DIR "/tests/ssm/silent_helper.sh", .limit = Millis(100)});
  plan = silent->Plan({Span("hello", "espeak-en")}, kNever);
  ASSERT_FALSE(plan);
  EXPECT_EQ(plan.error().code, vm::Errc::kTimeout);
  auto chatty = ssm::MakeEspeakEngine({.helper = "cat"});
  plan = chatty->Plan({Span("hello", "espeak-en")}, kNever);
  ASSERT_FALSE(plan);
  EXPECT_TRUE(plan.error().text.starts_with("the helper for espeak-ng answered 'say"))
      << plan.error().text;
}

#ifdef SSM_HAS_MECAB
TEST_F(EspeakTest, ChineseIsSaidWholeByTheVoiceOfChineseAndJapaneseStaysJapanese) {
  std::vector<std::unique_ptr<ssm::SpeechEngine>> engines;
  engines.push_back(std::move(engine_));
  ssm::EngineSet set(std::move(engines));
  const auto said = [&set](const std::string& text, const std::string& voice) {
    const auto plan = Speak(set, {Span(text, voice)}).plan;
    EXPECT_EQ(plan.unspoken, "") << text;
    return vm::FormatPhonemesVoice(plan.phonemes);
  };
  // 辶 is a character of Japanese for which its dictionary has no reading.
  for (const char* chinese : {"你好，世界", "谢谢", "辶世界"}) {
    EXPECT_EQ(said(chinese, "espeak-en"), said(chinese, "espeak-zh")) << chinese;
  }
  EXPECT_FALSE(said("你好", "espeak-en").contains("th[")) << "a tone is no English number";
  for (const char* japanese : {"東京都庁", "世界平和", "今日は晴れです"}) {
    EXPECT_EQ(said(japanese, "espeak-en"), said(japanese, "espeak-ja")) << japanese;
  }
}
#endif

TEST_F(EspeakTest, ASetOfEnginesSplitsATextByLanguage) {
  std::vector<std::unique_ptr<ssm::SpeechEngine>> engines;
  engines.push_back(std::move(engine_));
  ssm::EngineSet set(std::move(engines));
  ASSERT_TRUE(set.ChooseVoice("ru", "espeak-uk"));
  ASSERT_FALSE(set.ChooseVoice("ru", "nobody"));
  SpeechSpan marked = Span("мир is peace.", "espeak-en");
  marked.mark = "m";
  const auto plan = Speak(set, {marked, Span(" Yes.", "espeak-de")}).plan;
  ASSERT_EQ(plan.words.size(), 4u);
  EXPECT_EQ(plan.words[0].text, "мир");
  EXPECT_EQ(plan.words[3].text, "Yes");
  EXPECT_EQ(plan.marks, (std::vector<ssm::MarkTime>{{"m", Millis(0)}}));
  for (std::size_t i = 1; i < plan.words.size(); ++i) {
    EXPECT_GE(plan.words[i].start, plan.words[i - 1].start);
  }
}

}  // namespace
