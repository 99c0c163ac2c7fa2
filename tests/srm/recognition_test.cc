// The real engine on speech made by our own voice. Skipped where the model is not installed.

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <sstream>

#include "srm/align/phone_aligner.h"
#include "srm/engine/pronunciation.h"
#include "tests/srm/speech_world.h"

namespace {

using srm::Millis;
using namespace speech_world;

constexpr const char* kPhrases[] = {
    "yes please",           "no thank you",     "turn on the light",    "turn off the light",
    "open the window",      "close the window", "what time is it",      "tell me a story",
    "good morning",         "good night",       "call my mother",       "send a message",
    "play some music",      "stop the music",   "where is the station", "i want two apples",
    "three pounds of fish", "how much is it",   "that is all",          "start again"};

TEST_F(RecognitionTest, AnyWordsAreHeardForAsLongAsTheyLast) {
  Use("call * {CALL} | $GARBAGE weather $GARBAGE {WEATHER} | stop {STOP}");
  const auto meaning = [&](const std::string& text, const std::string& voice) {
    std::istringstream heard(Hear(Say(text, voice).samples).text);
    const std::vector<std::string> words{std::istream_iterator<std::string>(heard), {}};
    const auto match = grammar_->Match(words);
    return match ? match->Joined() : "-";
  };
  int right = 0;
  for (const char* voice : {"slt", "rms", "awb", "kal16"}) {
    right += meaning("call margaret", voice) == "CALL";
    right += meaning("call my brother in the city of london", voice) == "CALL";
    right += meaning("tell me about the weather in paris tomorrow", voice) == "WEATHER";
    right += meaning("weather", voice) == "WEATHER";
    EXPECT_EQ(meaning("stop", voice), "STOP") << voice;
  }
  EXPECT_GE(right, 14);
}

TEST_F(RecognitionTest, PhrasesOfThreeVoicesAreHeardAsTheyWereSaid) {
  std::string grammar;
  for (const char* phrase : kPhrases) grammar += std::string(phrase) + "\n";
  Use(grammar);
  int right = 0, all = 0;
  std::string wrong;
  for (const char* voice : {"slt", "rms", "awb"}) {
    for (const char* phrase : kPhrases) {
      const auto heard = Hear(Say(phrase, voice).samples);
      ++all;
      if (heard.text == phrase && heard.confidence > 0.5)
        ++right;
      else
        wrong += std::string(voice) + ": " + phrase + " -> " + heard.text + " " +
                 std::to_string(heard.fit) + "\n";
    }
  }
  RecordProperty("right", right);
  EXPECT_GE(right, all - 2) << wrong;
}

/// White noise 20 dB below the sound.
std::vector<std::int16_t> InNoise(std::vector<std::int16_t> samples) {
  const double rms = ssm_test::Rms(samples) / 10;
  std::uint32_t state = 1;
  for (std::int16_t& sample : samples) {
    state = state * 1664525u + 1013904223u;
    const double noise = (static_cast<double>(state >> 8) / (1 << 23) - 1) * rms * std::sqrt(3.0);
    sample = static_cast<std::int16_t>(std::lround(std::clamp(sample + noise, -32768.0, 32767.0)));
  }
  return samples;
}

TEST_F(RecognitionTest, NoiseThatComesAndGoesIsHeardThrough) {
  std::string grammar;
  for (const char* phrase : kPhrases) grammar += std::string(phrase) + "\n";
  Use(grammar);
  std::string wrong;
  int missed = 0;
  for (const char* voice : {"slt", "awb"}) {
    for (const char* phrase : kPhrases) {
      const Speech speech = Say(phrase, voice);
      Hear(speech.samples);
      const auto heard = Hear(InNoise(speech.samples));
      if (heard.text == phrase) continue;
      ++missed;
      wrong += std::string(voice) + ": " + phrase + " -> " + heard.text + " " +
               std::to_string(heard.fit) + "\n";
    }
  }
  EXPECT_EQ(missed, 0) << wrong;
}

TEST_F(RecognitionTest, WhatIsNotInTheGrammarHasLittleConfidence) {
  Use("yes please\nno thank you\nturn on the light\nwhat time is it");
  int accepted = 0;
  std::string which;
  const char* others[] = {"the weather was cold in december", "my brother lives in another country",
                          "seven people came to the party",   "she bought a large umbrella",
                          "computers are getting faster",     "we should leave before noon"};
  for (const char* other : others) {
    const auto heard = Hear(Say(other).samples);
    if (heard.confidence >= 0.5) {
      ++accepted;
      which += std::string(other) + " -> " + heard.text + " " + std::to_string(heard.fit) + "\n";
    }
  }
  EXPECT_LE(accepted, 1) << which;
}

TEST_F(RecognitionTest, NearMissesOfASmallGrammarAreRejected) {
  const struct {
    const char* grammar;
    std::vector<const char*> inside, outside;
  } cases[] = {
      {"open | close | lock | unlock",
       {"open", "close", "lock", "unlock"},
       {"hope", "look", "hello there", "what did you say", "good evening", "fifteen"}},
      {"small | medium | large",
       {"small", "medium", "large"},
       {"huge", "the biggest one", "pizza", "a little bit", "many", "excuse me"}},
      {"pizza | salad | soup of the day | fish and chips | the bill please",
       {"pizza", "salad", "soup of the day", "fish and chips", "the bill please"},
       {"pasta", "steak", "a table for two", "is it ready", "chicken and rice", "hurry up"}}};
  int lost = 0, rejected = 0, outside = 0;
  std::string wrong;
  for (const char* voice : {"rms", "kal16"}) {
    for (const auto& each : cases) {
      Use(each.grammar);
      const auto accepted = [&](const char* phrase) {
        const auto heard = Hear(Say(phrase, voice).samples);
        const bool taken = !heard.text.empty() && heard.confidence >= 0.5;
        wrong += std::string(voice) + ": " + phrase + (taken ? " taken for " : " rejected as ") +
                 heard.text + " " + std::to_string(heard.fit) + "\n";
        return taken;
      };
      for (const char* phrase : each.inside) lost += !accepted(phrase);
      for (const char* phrase : each.outside) rejected += !accepted(phrase), ++outside;
    }
  }
  EXPECT_EQ(lost, 0) << wrong;
  EXPECT_GE(rejected * 10, outside * 8) << wrong;
}

TEST_F(RecognitionTest, WhatIsDictatedIsBelieved) {
  ASSERT_TRUE(decoder_->Use({}));
  const auto heard = Hear(Say("the doctor will be back soon").samples);
  EXPECT_EQ(heard.text, "the doctor will be back soon");
  EXPECT_GT(heard.confidence, 0.5);
}

TEST_F(RecognitionTest, WordsOutsideTheDictionaryArePronouncedByRule) {
  Use("hello galatea\nhello vocaloid\nhello 15");
  EXPECT_EQ(Hear(Say("hello vocaloid").samples).text, "hello vocaloid");
  EXPECT_EQ(Hear(Say("hello fifteen").samples).text, "hello 15");
}

TEST_F(RecognitionTest, WordTimesAreThoseOfTheSound) {
  Use("turn on the light");
  const Speech speech = Say("turn on the light");
  const auto heard = Hear(speech.samples);
  ASSERT_EQ(heard.words.size(), speech.plan.words.size());
  for (std::size_t i = 0; i < heard.words.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(heard.words[i].start.count()),
                static_cast<double>(speech.plan.words[i].start.count()), 60);
  }
}

TEST_F(RecognitionTest, AnEmptySoundIsNothingHeard) {
  Use("yes");
  EXPECT_EQ(Hear({}).text, "");
}

TEST(PronunciationTest, KanaNumbersAndUnknownWordsCanBeSaid) {
  EXPECT_EQ(srm::PronunciationsOf("はい"), (std::vector<std::string>{"HH AA IY"}));
  EXPECT_EQ(srm::PronunciationsOf("です")[1], "D EH S");
  EXPECT_EQ(srm::PronunciationsOf("きょう")[0], "K Y AO UW");
  EXPECT_FALSE(srm::PronunciationsOf("galatea").empty());
  EXPECT_TRUE(srm::PronunciationsOf("--").empty());
  EXPECT_EQ(srm::NumberWords("1234"), "one thousand two hundred thirty four");
  EXPECT_EQ(srm::NumberWords("007"), "zero zero seven");
}

TEST(AlignTest, BoundariesAreNearTheSynthesizersOwn) {
  if (!HasModel()) GTEST_SKIP() << "the model is not installed (pocketsphinx-en-us)";
  auto aligner = srm::PhoneAligner::Open(kOptions.model);
  ASSERT_TRUE(aligner) << aligner.error().text;
  std::vector<double> errors;
  double signed_sum = 0;
  for (const char* text :
       {"please put my blue backpack on the table", "many people bought paper maps",
        "the big dog barked at the postman", "where is the nearest station"}) {
    const Speech speech = Say(text);
    auto found = (*aligner)->Align(speech.samples, text);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_EQ(vm::TotalDuration(found->phonemes).count(),
              static_cast<std::int64_t>(speech.samples.size() / 16));
    EXPECT_EQ(found->words.size(), speech.plan.words.size());
    if (found->phonemes.size() != speech.plan.phonemes.size()) continue;  // another pronunciation
    Millis ours{0}, theirs{0};
    for (std::size_t i = 0; i + 1 < found->phonemes.size(); ++i) {
      ours += found->phonemes[i].duration;
      theirs += speech.plan.phonemes[i].duration;
      const double error = static_cast<double>((ours - theirs).count());
      errors.push_back(std::abs(error));
      signed_sum += error;
    }
  }
  ASSERT_GT(errors.size(), 40u);
  std::sort(errors.begin(), errors.end());
  const double median = errors[errors.size() / 2];
  std::printf("alignment: %zu boundaries, median %.0f ms, 98 %% within %.0f ms, bias %.1f ms\n",
              errors.size(), median, errors[errors.size() * 98 / 100],
              signed_sum / static_cast<double>(errors.size()));
  EXPECT_LE(median, 20);
}

TEST(AlignTest, TextThatCannotBeSaidOrDoesNotFitIsAnError) {
  if (!HasModel()) GTEST_SKIP() << "the model is not installed (pocketsphinx-en-us)";
  auto aligner = srm::PhoneAligner::Open(kOptions.model);
  ASSERT_TRUE(aligner);
  const Speech speech = Say("yes");
  EXPECT_FALSE((*aligner)->Align(speech.samples, "..."));
  EXPECT_FALSE(srm::PhoneAligner::Open("/nowhere"));
}

TEST(AlignFormatTest, EveryFormatHoldsPhonemesAndWords) {
  const srm::Alignment alignment{.phonemes = {{"pau", Millis(100)}, {"hh", Millis(50)}},
                                 .words = {{"hi", Millis(100), Millis(150)}}};
  EXPECT_EQ(*srm::FormatAlignment(alignment, "pho"), "pau[100] hh[50]\n");
  EXPECT_EQ(*srm::FormatAlignment(alignment, "tsv"),
            "0\t100\tphoneme\tpau\n100\t150\tphoneme\thh\n100\t150\tword\thi\n");
  EXPECT_EQ(*srm::FormatAlignment(alignment, "json"),
            "{\"phonemes\":[{\"ms\":100,\"name\":\"pau\"},{\"ms\":50,\"name\":\"hh\"}],"
            "\"words\":[{\"confidence\":1.0,\"end\":150,\"start\":100,\"text\":\"hi\"}]}\n");
  EXPECT_NE(srm::FormatAlignment(alignment, "textgrid")->find("xmax = 0.15"), std::string::npos);
  EXPECT_FALSE(srm::FormatAlignment(alignment, "xml"));
}

}  // namespace
