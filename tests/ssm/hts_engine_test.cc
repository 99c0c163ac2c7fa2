// The engine that mixes voice files, with a voice the user names (GALATEA_HTSVOICE) and a second
// made from it here: every pitch, duration and loudness of its models moved by a known amount, so
// what the mixture must sound like is known. Skipped where there is no voice file.

#include "ssm/engines/hts_engine.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include "ssm/engines/hts_voices.h"
#include "ssm/engines/open_jtalk_engine.h"
#include "ssm/engines/wav_piece.h"
#include "ssm/voice/pitch_track.h"
#include "tests/ssm/spoken.h"
#include "tests/support/test_data.h"

namespace {

using ssm::Millis;

constexpr double kPitch = 0.8, kStretch = 1.5, kLoudness = 0.6;
const std::string kText = "今日は良い天気ですね。";

support::TestData Voice() {
  return {"an HTS voice file", "GALATEA_HTSVOICE", "voices/mei/mei_normal.htsvoice"};
}

std::string Bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The numbers of one PDF section: 32 bit counts of its `trees`, then for each PDF `length` floats.
class Section {
 public:
  Section(std::string& bytes, const std::string& key, std::size_t trees) : bytes_(bytes) {
    const std::size_t line = bytes.find("\n" + key + ":") + key.size() + 2;
    begin_ = bytes.find("[DATA]\n") + 7 + std::stoul(bytes.substr(line));
    for (std::size_t i = 0; i < trees; ++i) count_ += Read<std::uint32_t>(begin_ + 4 * i);
    begin_ += 4 * trees;
  }
  template <typename Change>
  void ForEach(std::size_t length, std::size_t first, std::size_t values, Change change) {
    for (std::size_t pdf = 0; pdf < count_; ++pdf) {
      for (std::size_t i = first; i < first + values; ++i) {
        const std::size_t at = begin_ + 4 * (pdf * length + i);
        const auto value = static_cast<float>(change(Read<float>(at)));
        std::memcpy(bytes_.data() + at, &value, sizeof value);
      }
    }
  }

 private:
  template <typename T>
  T Read(std::size_t at) const {
    T value;
    std::memcpy(&value, bytes_.data() + at, sizeof value);
    return value;
  }
  std::string& bytes_;
  std::size_t begin_ = 0, count_ = 0;
};

/// The voice with another pitch, pace and loudness. Its sizes are those of Mei: 5 states; 35
/// coefficients with two differences; pitch with two differences and the share of voiced frames.
std::string Changed(std::string bytes) {
  Section(bytes, "DURATION_PDF", 1).ForEach(10, 0, 5, [](float mean) { return mean * kStretch; });
  Section(bytes, "STREAM_PDF[LF0]", 5).ForEach(7, 0, 1, [](float mean) {
    return mean + std::log(kPitch);
  });
  Section(bytes, "STREAM_PDF[MCP]", 5).ForEach(210, 0, 1, [](float mean) {
    return mean + std::log(kLoudness);
  });
  return bytes;
}

struct Heard {
  double pitch_hz = 0, rms = 0;
  vm::PhonemeList phonemes{};
  double ms() const { return static_cast<double>(vm::TotalDuration(phonemes).count()); }
};

class HtsEngineTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto voice = Voice(); !voice.Has()) GTEST_SKIP() << voice.Missing();
    std::ofstream(changed_, std::ios::binary) << Changed(Bytes(Voice().path()));
    if (auto good = ssm::CheckOpenJtalkDictionary({}); !good) GTEST_SKIP() << good.error().text;
    auto engine = Make(changed_);
    ASSERT_TRUE(engine) << engine.error().text;
    engine_ = std::move(*engine);
  }
  vm::Result<std::unique_ptr<ssm::SpeechEngine>> Make(const std::string& happy) const {
    return ssm::MakeHtsEngine({.analysis = {.name = "mei", .voice_file = Voice().path()},
                               .emotions = {{"HAPPY", happy}}});
  }
  /// As the voice module asks for an emotion.
  static ssm::SpeechSpan Feeling(const std::string& emotion, double strength) {
    const ssm::Manner manner = *ssm::MannerOf(emotion, strength);
    return {.text = kText,
            .voice = "mei",
            .stretch = 1 / manner.rate,
            .pitch = manner.pitch,
            .volume = manner.volume,
            .feeling = {emotion, strength / 100, manner}};
  }
  static Heard Hear(ssm::SpeechEngine& engine, const ssm::SpeechSpan& span) {
    const ssm_test::Spoken spoken = ssm_test::Speak(engine, {span});
    Heard heard{.rms = ssm_test::Rms(spoken.samples), .phonemes = spoken.plan.phonemes};
    double sum = 0;
    std::size_t voiced = 0;
    for (const double hz : ssm::MeasurePitch(spoken.samples).hz) {
      sum += hz > 0 ? std::log(hz) : 0;
      voiced += hz > 0 ? 1u : 0u;
    }
    heard.pitch_hz = std::exp(sum / static_cast<double>(voiced));
    return heard;
  }
  std::string ErrorOf(const std::string& bytes) const {
    const std::string path = folder_.File("bad.htsvoice");
    std::ofstream(path, std::ios::binary) << bytes;
    auto engine = Make(path);
    return engine ? "" : engine.error().text;
  }
  const ssm::TemporaryFolder folder_;
  const std::string changed_ = folder_.File("changed.htsvoice");
  std::unique_ptr<ssm::SpeechEngine> engine_;
};

TEST_F(HtsEngineTest, StrengthMovesTheVoiceFromOneFileToTheOther) {
  const Heard own = Hear(*engine_, Feeling("HAPPY", 0));
  for (const double strength : {0.0, 25.0, 50.0, 75.0, 100.0}) {
    const Heard mixed = Hear(*engine_, Feeling("HAPPY", strength));
    const double part = strength / 100;
    RecordProperty("strength" + std::to_string(static_cast<int>(strength)),
                   std::to_string(mixed.pitch_hz) + " Hz, " + std::to_string(mixed.ms()) +
                       " ms, rms " + std::to_string(mixed.rms));
    EXPECT_NEAR(mixed.pitch_hz / own.pitch_hz, std::pow(kPitch, part), 0.03) << strength;
    EXPECT_NEAR(mixed.ms() / own.ms(), 1 + part * (kStretch - 1), 0.03) << strength;
    EXPECT_NEAR(mixed.rms / own.rms, std::pow(kLoudness, part), 0.12) << strength;
  }
}

TEST_F(HtsEngineTest, ItsOwnVoiceIsThatOfTheProgram) {
  auto program = ssm::MakeOpenJtalkEngine({.name = "mei", .voice_file = Voice().path()});
  ASSERT_TRUE(program);
  const Heard theirs = Hear(**program, {.text = kText}), ours = Hear(*engine_, {.text = kText});
  EXPECT_EQ(vm::FormatPhonemesVoice(ours.phonemes), vm::FormatPhonemesVoice(theirs.phonemes));
  EXPECT_NEAR(ours.pitch_hz, theirs.pitch_hz, 1);
  EXPECT_NEAR(ours.rms / theirs.rms, 1, 0.02);
}

TEST_F(HtsEngineTest, AnEmotionWithoutAFileChangesSpeedAndPitch) {
  const Heard own = Hear(*engine_, Feeling("NEUTRAL", 100));
  const Heard sad = Hear(*engine_, Feeling("SAD", 100));
  const ssm::Manner manner = *ssm::MannerOf("SAD", 100);
  EXPECT_NEAR(sad.ms() / own.ms(), 1 / manner.rate, 0.03);
  EXPECT_NEAR(sad.pitch_hz / own.pitch_hz, manner.pitch, 0.03);
  ssm::SpeechSpan plain = Feeling("SAD", 100);
  plain.volume = 1;
  EXPECT_NEAR(sad.rms / Hear(*engine_, plain).rms, manner.volume, 0.01);
}

TEST_F(HtsEngineTest, WordsAndLaterSentencesHaveTheirPlaces) {
  auto plan = engine_->Plan({{.text = "はい。", .mark = "a"}, {.text = kText, .mark = "b"}},
                            ssm_test::kNever);
  ASSERT_TRUE(plan) << plan.error().text;
  ASSERT_EQ(plan->marks.size(), 2u);
  ASSERT_GE(plan->words.size(), 4u);
  EXPECT_EQ(plan->words[0].text, "はい");
  EXPECT_EQ(plan->words[1].text, "今日");
  EXPECT_GT(plan->words[1].start, plan->marks[1].at);
}

TEST_F(HtsEngineTest, SoundIsNotMadeForWhatWasStopped) {
  auto plan = engine_->Plan({{.text = kText}}, ssm_test::kNever);
  ASSERT_TRUE(plan);
  ssm::SampleBuffer samples(ssm::ToFrames(vm::TotalDuration(plan->phonemes)));
  samples.Cancel();
  auto rendered = engine_->Render(*plan, samples);
  ASSERT_FALSE(rendered);
  EXPECT_EQ(rendered.error().code, vm::Errc::kStopped);
  EXPECT_TRUE(samples.Ready().empty());
}

TEST_F(HtsEngineTest, VoiceFilesThatAreNoneOrDoNotFitAreRefused) {
  const std::string good = Bytes(Voice().path());
  EXPECT_NE(ErrorOf("nonsense").find("is no voice file, expected it to begin [GLOBAL]"),
            std::string::npos);
  EXPECT_NE(ErrorOf(good.substr(0, good.size() / 2)).find("bytes of data"), std::string::npos);
  const std::size_t data = good.find("[DATA]\n") + 7;
  EXPECT_NE(ErrorOf(good.substr(0, data) + std::string(good.size() - data, '\0'))
                .find("hts_engine cannot speak with them"),
            std::string::npos);
  std::string other = good;
  other.replace(other.find("FREQUENCY:48000"), 15, "FREQUENCY:44100");
  EXPECT_NE(ErrorOf(other).find("SAMPLING_FREQUENCY is '44100', expected '48000'"),
            std::string::npos);
}

}  // namespace
