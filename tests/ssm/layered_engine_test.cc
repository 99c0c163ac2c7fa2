// Marks and manners laid over sentences that the engines have analysed whole.

#include "ssm/voice/layered_engine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "ssm/engines/engine_set.h"
#include "ssm/engines/hts_engine.h"
#include "ssm/engines/open_jtalk_engine.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/flite/flite_engine.h"
#include "ssm/voice/pitch_track.h"
#include "ssm/voice/ssml.h"
#include "ssm/voice/wav_file.h"
#include "ssm_stub/rule_engine.h"
#include "tests/ssm/marked_up.h"
#include "tests/ssm/spoken.h"
#include "tests/support/test_data.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/core/xml_text.h"

namespace {

using ssm::Millis;
using ssm::SpeechPlan;
using ssm_test::kNever;

std::vector<std::string> Sentences(const std::string& language) {
  std::ifstream file(GALATEA_SOURCE_DIR "/tests/ssm/sentences_" + language + ".txt");
  std::vector<std::string> sentences;
  for (std::string line; std::getline(file, line);) sentences.push_back(line);
  EXPECT_EQ(sentences.size(), 50u);
  return sentences;
}

std::vector<ssm::SpeechSpan> Spans(const std::string& inside, const std::string& voice) {
  auto read = ssm::ReadMarkup("<speak version='1.1'>" + inside + "</speak>");
  EXPECT_TRUE(read) << inside;
  for (ssm::SpeechSpan& span : read->spans) {
    if (span.voice.empty()) span.voice = voice;
  }
  return std::move(read->spans);
}

SpeechPlan Plan(ssm::SpeechEngine& engine, const std::string& inside, const std::string& voice) {
  auto plan = engine.Plan(Spans(inside, voice), kNever);
  EXPECT_TRUE(plan) << inside << (plan ? "" : plan.error().text);
  return plan ? std::move(*plan) : SpeechPlan{};
}

/// The sentence with `markup` before every sign of it.
std::string Everywhere(const std::string& sentence, const std::string& markup) {
  std::string marked;
  for (std::size_t at = 0; at < sentence.size();) {
    const std::size_t length = vm::SignAt(sentence, at).length;
    marked += markup + vm::EscapeXml(std::string_view(sentence).substr(at, length));
    at += length;
  }
  return marked;
}

/// Each word between the tags.
std::string AroundWords(const std::string& sentence, const std::string& open,
                        const std::string& close) {
  std::string marked = open;
  for (const char c : sentence) {
    marked += c == ' ' ? close + " " + open : vm::EscapeXml(std::string_view(&c, 1));
  }
  return marked + close;
}

/// `quick`: marks only; every text is a program run of a tenth of a second.
void ExpectUntouched(std::unique_ptr<ssm::SpeechEngine> below, const std::string& language,
                     const std::string& voice, bool quick = false) {
  ssm::LayeredEngine engine(std::move(below));
  for (const std::string& sentence : Sentences(language)) {
    const SpeechPlan plain = Plan(engine, vm::EscapeXml(sentence), voice);
    const auto same = [&](const std::string& inside) {
      const SpeechPlan marked = Plan(engine, inside, voice);
      EXPECT_EQ(marked.phonemes, plain.phonemes) << inside;
      EXPECT_EQ(marked.words, plain.words) << inside;
      return marked;
    };
    const SpeechPlan marked = same(Everywhere(sentence, "<mark name='m'/>"));
    EXPECT_EQ(marked.marks.size(), vm::SignsOf(sentence).size());
    for (std::size_t i = 1; i < marked.marks.size(); ++i) {
      EXPECT_GE(marked.marks[i].at, marked.marks[i - 1].at) << sentence;
    }
    ASSERT_FALSE(plain.words.empty()) << sentence;
    EXPECT_EQ(marked.marks.front().at, plain.words.front().start) << sentence;
    if (quick) continue;
    same(Everywhere(sentence, "<break strength='none'/>"));
    same(AroundWords(sentence, "<emphasis level='none'>", "</emphasis>"));
    same(AroundWords(sentence, "<prosody rate='100%'>", "</prosody>"));
    same(AroundWords(sentence, "<token>", "</token>"));
  }
}

TEST(LayeredEngineTest, MarksAnywhereChangeNothingOfTheStub) {
  ExpectUntouched(ssm_stub::MakeRuleEngine(), "en", "");
  ExpectUntouched(ssm_stub::MakeRuleEngine(), "ja", "");
}

TEST(LayeredEngineTest, MarksAnywhereChangeNothingOfFlite) {
  ExpectUntouched(ssm::MakeFliteEngine(), "en", "slt");
}

TEST(LayeredEngineTest, MarksAnywhereChangeNothingOfEspeak) {
  if (!ssm_test::Espeak()) GTEST_SKIP() << "built without espeak-ng";
  ExpectUntouched(ssm_test::Espeak(), "en", "espeak-en");
#ifdef SSM_HAS_MECAB
  ExpectUntouched(ssm_test::Espeak(), "ja", "espeak-ja");
#endif
}

TEST(LayeredEngineTest, MarksAnywhereChangeNothingOfVoiceFiles) {
  const support::TestData voice{"an HTS voice file", "GALATEA_HTSVOICE",
                                "voices/mei/mei_normal.htsvoice"};
  if (!voice.Has()) GTEST_SKIP() << voice.Missing();
  auto engine = ssm::MakeOpenJtalkEngine({.name = "mei", .voice_file = voice.path()});
  if (!engine) GTEST_SKIP() << engine.error().text;
  ExpectUntouched(std::move(*engine), "ja", "mei", true);
}

std::vector<std::unique_ptr<ssm::SpeechEngine>> OneFlite() {
  std::vector<std::unique_ptr<ssm::SpeechEngine>> engines;
  engines.push_back(ssm::MakeFliteEngine());
  return engines;
}

class OverFliteTest : public testing::Test {
 protected:
  ssm_test::Spoken Said(const std::string& inside) {
    return ssm_test::Speak(engine_, Spans(inside, "slt"));
  }
  static Millis Length(const ssm_test::Spoken& said) {
    return vm::TotalDuration(said.plan.phonemes);
  }
  ssm::LayeredEngine engine_{std::make_unique<ssm::EngineSet>(OneFlite())};
};

TEST_F(OverFliteTest, EmphasisOfMostOfASentenceLeavesItsPausesAlone) {
  const auto plain = Said("Good morning, Anna.");
  const auto strong = Said("Good <emphasis>morning, Anna</emphasis>.");
  ASSERT_EQ(strong.plan.phonemes.size(), plain.plan.phonemes.size());
  EXPECT_EQ(strong.plan.phonemes.front(), plain.plan.phonemes.front());
  EXPECT_EQ(strong.plan.phonemes.back(), plain.plan.phonemes.back());
  EXPECT_EQ(strong.plan.words[0], plain.plan.words[0]);
  EXPECT_GT(Length(strong), Length(plain));
}

TEST_F(OverFliteTest, AMannerChangesItsWordsAndNothingElse) {
  const auto plain = Said("I want the red one please");
  const auto slow = Said("I want the <prosody rate='50%'>red</prosody> one please");
  ASSERT_EQ(slow.plan.words.size(), plain.plan.words.size());
  for (std::size_t i = 0; i < plain.plan.words.size(); ++i) {
    const Millis own = plain.plan.words[i].end - plain.plan.words[i].start;
    const Millis now = slow.plan.words[i].end - slow.plan.words[i].start;
    EXPECT_EQ(now, i == 3 ? 2 * own : own) << i;
  }
}

/// The stub's words as one tone: the same text has the same sound to the sample.
class ToneEngine final : public ssm::SpeechEngine {
 public:
  const std::vector<ssm::VoiceInfo>& voices() const override { return rules_->voices(); }
  vm::Result<SpeechPlan> Plan(const std::vector<ssm::SpeechSpan>& spans,
                              const std::atomic<bool>& cancelled) override {
    return rules_->Plan(spans, cancelled);
  }
  vm::Result<void> Render(const SpeechPlan&, ssm::SampleBuffer& samples) override {
    std::vector<std::int16_t> tone(samples.size());
    for (std::size_t i = 0; i < tone.size(); ++i) {
      tone[i] = static_cast<std::int16_t>(static_cast<int>(i * 7 % 100) * 100 - 5000);
    }
    samples.Append(tone);
    return {};
  }

 private:
  std::unique_ptr<ssm::SpeechEngine> rules_ = ssm_stub::MakeRuleEngine();
};

TEST(LayeredEngineTest, SoundOutsideOfAMannerStaysAsItWas) {
  ssm::LayeredEngine engine(std::make_unique<ToneEngine>());
  const auto plain = ssm_test::Speak(engine, Spans("I want the red one please", ""));
  const auto slow = ssm_test::Speak(
      engine, Spans("I want the <prosody rate='50%' volume='25'>red</prosody> one please", ""));
  const auto frames = [](Millis time) { return static_cast<std::ptrdiff_t>(ssm::ToFrames(time)); };
  const auto before = frames(plain.plan.words[3].start);
  EXPECT_TRUE(
      std::equal(plain.samples.begin(), plain.samples.begin() + before, slow.samples.begin()));
  // Behind the word, 5 ms go from one sound into the other.
  const auto after = std::ssize(plain.samples) - frames(plain.plan.words[3].end) - 80;
  EXPECT_TRUE(
      std::equal(plain.samples.end() - after, plain.samples.end(), slow.samples.end() - after));
}

double MeanHz(const ssm_test::Spoken& said, std::size_t first, std::size_t last) {
  const std::size_t begin = ssm::ToFrames(said.plan.words[first].start);
  const std::size_t end = ssm::ToFrames(said.plan.words[last].end);
  const auto track = ssm::MeasurePitch(std::span(said.samples).subspan(begin, end - begin));
  double sum = 0;
  int count = 0;
  for (const double hz : track.hz) {
    if (hz == 0) continue;
    sum += std::log(hz);
    ++count;
  }
  return count == 0 ? 0 : std::exp(sum / count);
}

/// Between the quarters of its pitches, in log Hz.
double Spread(const ssm_test::Spoken& said) {
  std::vector<double> pitches;
  for (const double hz : ssm::MeasurePitch(said.samples).hz) {
    if (hz > 0) pitches.push_back(std::log(hz));
  }
  std::ranges::sort(pitches);
  return pitches[pitches.size() * 3 / 4] - pitches[pitches.size() / 4];
}

TEST_F(OverFliteTest, PitchInHertzIsThePitchHeard) {
  const std::string text = "we are rolling along a yellow road";
  const double own = MeanHz(Said(text), 0, 6);
  EXPECT_NEAR(MeanHz(Said("<prosody pitch='250Hz'>" + text + "</prosody>"), 0, 6), 250, 10);
  EXPECT_NEAR(MeanHz(Said("<prosody pitch='+60Hz'>" + text + "</prosody>"), 0, 6), own + 60, 10);
  EXPECT_NEAR(MeanHz(Said("<prosody pitch='-30Hz'>" + text + "</prosody>"), 0, 6), own - 30, 10);
}

TEST_F(OverFliteTest, RangeIsHowFarThePitchGoes) {
  const std::string text = "we are rolling along a yellow road";
  const double own = Spread(Said(text));
  EXPECT_LT(Spread(Said("<prosody range='x-low'>" + text + "</prosody>")), 0.7 * own);
  EXPECT_GT(Spread(Said("<prosody range='x-high'>" + text + "</prosody>")), 1.4 * own);
}

TEST_F(OverFliteTest, AContourBendsThePitchOverItsElement) {
  const std::string text = "we are rolling along a yellow road";
  const auto plain = Said(text);
  const auto bent = Said("<prosody contour='(0%,+0Hz) (100%,+40%)'>" + text + "</prosody>");
  EXPECT_NEAR(MeanHz(bent, 0, 0) / MeanHz(plain, 0, 0), 1.04, 0.06);
  EXPECT_NEAR(MeanHz(bent, 6, 6) / MeanHz(plain, 6, 6), 1.36, 0.1);
}

TEST_F(OverFliteTest, ADurationIsKept) {
  const auto said = Said("I <prosody duration='2s'>want the red</prosody> one");
  EXPECT_EQ(said.plan.words[3].end - said.plan.words[1].start, Millis(2000));
}

TEST_F(OverFliteTest, ADurationOutOfReachIsTold) {
  const auto said = Said("I <prosody duration='50s'>want</prosody> one");
  EXPECT_TRUE(said.plan.unspoken.starts_with("a duration of 50000 ms is asked of "))
      << said.plan.unspoken;
  EXPECT_EQ(Said("I <prosody duration='1s'>want</prosody> one").plan.unspoken, "");
}

TEST_F(OverFliteTest, ASoundRepeatedBeyondTheLimitIsTold) {
  const ssm::TemporaryFolder folder;
  const std::string wav = folder.File("second.wav");
  ASSERT_TRUE(ssm::WriteWav(wav, std::vector<std::int16_t>(16'000, 100)));
  const auto planned = [&](const std::string& count) {
    return Plan(engine_, "<audio src='" + wav + "' repeatCount='" + count + "'/>", "slt");
  };
  const SpeechPlan cut = planned("700");
  EXPECT_EQ(vm::TotalDuration(cut.phonemes), ssm::kLongestPlayed);
  EXPECT_EQ(cut.unspoken, "'" + wav + "' is repeated for 600 s, the limit");
  EXPECT_EQ(planned("600").unspoken, "");
}

TEST_F(OverFliteTest, VolumeIsOnItsScaleAndNeverCut) {
  const std::string text = "we are rolling along";
  const double own = ssm_test::Rms(Said(text).samples);
  const auto level = [&](const std::string& volume) {
    return ssm_test::Rms(Said("<prosody volume='" + volume + "'>" + text + "</prosody>").samples) /
           own;
  };
  EXPECT_NEAR(level("50"), 0.5, 0.02);
  EXPECT_NEAR(level("100"), 1, 0.02);
  EXPECT_NEAR(level("-6dB"), 0.5, 0.02);
  EXPECT_NEAR(level("silent"), 0, 0.001);
  const auto loud = Said("<prosody volume='+12dB'>" + text + "</prosody>");
  EXPECT_EQ(std::ranges::count(loud.samples, 32767), 0);
}

TEST_F(OverFliteTest, APauseInsideASentenceIsPutIn) {
  const auto plain = Said("good morning to you");
  const auto parted = Said("good <break time='700ms'/>morning to you");
  EXPECT_EQ(Length(parted), Length(plain) + Millis(700));
  ASSERT_EQ(parted.plan.words.size(), 4u);
  EXPECT_EQ(parted.plan.words[1].start - parted.plan.words[0].end, Millis(700));
  const auto marked = Said("good <mark name='a'/><break time='700ms'/><mark name='b'/>morning");
  ASSERT_EQ(marked.plan.marks.size(), 2u);
  EXPECT_EQ(marked.plan.marks[1].at - marked.plan.marks[0].at, Millis(700));
  EXPECT_EQ(marked.plan.marks[1].at, marked.plan.words[1].start);
}

TEST_F(OverFliteTest, MarksFindWordsThatAreReadInOtherWords) {
  const auto said = Said("Dr. Smith owns <mark name='m'/>20 horses and <mark name='n'/>$5");
  ASSERT_EQ(said.plan.marks.size(), 2u);
  const auto start = [&](const std::string& word) {
    for (const auto& it : said.plan.words) {
      if (it.text == word) return it.start;
    }
    ADD_FAILURE() << word;
    return Millis(0);
  };
  EXPECT_EQ(said.plan.marks[0].at, start("twenty"));
  EXPECT_EQ(said.plan.marks[1].at, start("five"));
}

}  // namespace
