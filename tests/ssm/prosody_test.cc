// Prosody files, analyses made by hand, pronunciations: what they change in the sound.

#include "ssm/voice/prosody.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "ssm/voice/parsed_text.h"
#include "ssm/voice/pitch_track.h"
#include "ssm/voice/pronounced_text.h"
#include "ssm/voice/wav_file.h"
#include "tests/ssm/voice_suite.h"
#include "tests/support/process.h"

namespace ssm_test {
namespace {

using ssm::Millis;

/// A buzz: pulses of a decaying tone, `hz` times a second.
std::vector<std::int16_t> Buzz(int ms, double hz) {
  std::vector<std::int16_t> samples(ssm::ToFrames(Millis(ms)));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double phase = std::fmod(static_cast<double>(i) * hz / 16000, 1.0);
    const double since = phase / hz;
    samples[i] = static_cast<std::int16_t>(8000 * std::exp(-since * 300) *
                                           std::cos(2 * std::numbers::pi * 700 * since));
  }
  return samples;
}

double MedianPitch(std::span<const std::int16_t> samples) {
  std::vector<double> voiced;
  for (const double hz : ssm::MeasurePitch(samples).hz) {
    if (hz > 0) voiced.push_back(hz);
  }
  if (voiced.empty()) return 0;
  std::nth_element(voiced.begin(), voiced.begin() + std::ssize(voiced) / 2, voiced.end());
  return voiced[voiced.size() / 2];
}

TEST(PitchTrackTest, MeasuresABuzzAndHearsNoVoiceInNoise) {
  for (const double hz : {80.0, 143.0, 250.0, 400.0}) {
    EXPECT_NEAR(MedianPitch(Buzz(600, hz)), hz, hz * 0.01);
  }
  std::vector<std::int16_t> noise(9600);
  std::uint32_t state = 3;
  for (auto& s : noise) {
    state = state * 1664525u + 1013904223u;
    s = static_cast<std::int16_t>(static_cast<int>(state >> 18) - 8192);
  }
  EXPECT_EQ(MedianPitch(noise), 0);
}

TEST(ReshapeTest, DurationsAndPitchAreThoseAskedForAndTheTimbreStays) {
  const ssm::SpeechPlan plan{.phonemes = {{"a", Millis(400)}, {"o", Millis(400)}}};
  ssm::Prosody wanted{.text = "x", .phonemes = {{"a", Millis(300)}, {"o", Millis(700)}}};
  for (int i = 0; i <= 200; ++i) {
    wanted.f0.push_back(std::log(180));
    wanted.power.push_back(std::log(1500));
  }
  ssm::SampleBuffer samples(ssm::ToFrames(Millis(1000)));
  ssm::Reshape(Buzz(800, 140), plan, wanted, samples);
  ASSERT_TRUE(samples.complete());
  EXPECT_NEAR(MedianPitch(samples.Ready()), 180, 4);
  double power = 0;
  for (const auto s : samples.Ready().subspan(1600, 12000)) power += double{1} * s * s;
  EXPECT_NEAR(20 * std::log10(std::sqrt(power / 12000) / 1500), 0, 2.5);
}

TEST(ProsodyFileTest, MalformedFilesAreRefusedWithTheirLine) {
  const support::TempDir dir;
  const std::string head = "input_text: a\nspoken_text: a\n-----\n";
  const struct {
    const char* rest;
    const char* said;
  } cases[] = {{"", "line 3"},
               {"a [x]\n-----\n", "line 5"},
               {"a [10]\n-----\ntotal_frame: 1\n-----\n0: 5\n", "line 8"},
               {"a [10]\n-----\ntotal_frame: 1\n-----\n1: 5 6\n", "line 8"},
               {"a [10]\n-----\ntotal_frame: 1\n-----\n0: nan 6\n", "line 8"},
               {"a [10]\n-----\ntotal_frame: 1\n-----\n0: 99 6\n", "line 8"}};
  for (const auto& one : cases) {
    std::ofstream(dir / "x.pros") << head << one.rest;
    const auto read = ssm::ReadProsody(dir / "x.pros");
    ASSERT_FALSE(read) << one.rest;
    EXPECT_NE(read.error().text.find(one.said), std::string::npos) << read.error().text;
  }
}

class ProsodyTest : public VoiceSuite {};
INSTANTIATE_TEST_SUITE_P(Engines, ProsodyTest, AllEngines(), EngineName);

TEST_P(ProsodyTest, AFileSavedAndLoadedSaysTheSameAndAChangedOneWhatItAsksFor) {
  const support::TempDir dir;
  const long dur = Prepare("Hello.");
  const std::string pho = world_.Ask("Text.pho");
  world_.Tell("set SavePros = " + dir / "a.pros");
  world_.Tell("set LoadPros = " + dir / "a.pros");
  EXPECT_EQ(world_.errors, Lines{});
  EXPECT_EQ(world_.Ask("Text.pho"), pho);
  EXPECT_EQ(world_.Ask("ProsFile"), dir / "a.pros");
  auto prosody = *ssm::ReadProsody(dir / "a.pros");
  for (auto& phoneme : prosody.phonemes) phoneme.duration *= 2;
  ASSERT_TRUE(ssm::WriteProsody(prosody, dir / "b.pros"));
  world_.Tell("set ProsFile = " + dir / "b.pros");
  EXPECT_EQ(world_.Ask("Text.dur"), std::to_string(2 * dur));
  world_.Tell("set SaveWAV = " + dir / "b.wav");
  EXPECT_EQ(ssm::ReadWav(dir / "b.wav")->size(), ssm::ToFrames(Millis(2 * dur)));
  prosody.phonemes.pop_back();
  ASSERT_TRUE(ssm::WriteProsody(prosody, dir / "c.pros"));
  world_.Lines();
  world_.Tell("set#3 LoadPros = " + dir / "c.pros");
  const Lines lines = world_.Lines();
  EXPECT_TRUE(lines.back().starts_with("rep#3 LoadPros.error = BAD_VALUE")) << lines.back();
  world_.Tell("set Text = Hello.");
  EXPECT_EQ(world_.Ask("Speak.stat"), "READY");
}

TEST(ParsedTextTest, WordsOfAnAnalysisHaveTheirReadings) {
  EXPECT_EQ(*ssm::TextOfParsed("<S><AP accent=\"1\"><W2 orth=\"今日\" pron=\"キョー\" pos=\"名詞\">"
                               "<W1 orth=\"今\"/></W2></AP><SILENCE MSEC=\"200\"/>"
                               "<W2 orth=\"。\" pron=\"\"/></S>"),
            "<PRON SYM=\"キョー\">今日</PRON><SILENCE MSEC=\"200\"/>。");
  EXPECT_EQ(ssm::TextOfParsed("<S><W2").error().code, vm::Errc::kSyntax);
  EXPECT_EQ(ssm::TextOfParsed("<S></S>").error().code, vm::Errc::kBadValue);
}

TEST(ParsedTextTest, QuotesAndAmpersandsInAttributesStayMarkup) {
  EXPECT_EQ(*ssm::TextOfParsed("<S><VOICE NAME=\"A &amp; &quot;B&quot;\"><W2 orth=\"x\" pron=\"\"/>"
                               "</VOICE></S>"),
            "<VOICE NAME=\"A &amp; &quot;B&quot;\">x</VOICE>");
}

TEST(PronouncedTextTest, IpaSampaAndArpabetAreOneForAnEngine) {
  EXPECT_EQ(*ssm::IpaForFlite("təˈmɑːtoʊ"), "t ax0 m aa1 t ow0");
  EXPECT_EQ(*ssm::IpaForFlite(*ssm::IpaOfSampa("t@\"mA:toU")), "t ax0 m aa1 t ow0");
  EXPECT_EQ(*ssm::IpaForFlite(*ssm::IpaOfArpabet("T AX M AA1 T OW")), "t ax0 m aa1 t ow0");
  EXPECT_EQ(*ssm::IpaForEspeak("t͡ʃɪ.p"), "'tSIp");
  EXPECT_NE(ssm::IpaForFlite("t#").error().text.find("'#'"), std::string::npos);
  EXPECT_FALSE(ssm::IpaForFlite(""));
}

TEST(PronouncedTextTest, FliteSaysAWordAsItIsPronouncedAndNamesItAsItIsWritten) {
  const auto engine = ssm::MakeFliteEngine();
  const std::atomic<bool> never{false};
  const auto plan = engine->Plan(
      {{.text = "I say " + ssm::Pronounced("təˈmɑːtoʊ", "tomato") + " today.", .voice = "kal16"}},
      never);
  ASSERT_TRUE(plan) << plan.error().text;
  std::string names;
  for (const auto& phoneme : plan->phonemes) names += phoneme.name + " ";
  EXPECT_NE(names.find("t ax m aa t ow "), std::string::npos) << names;
  ASSERT_EQ(plan->words.size(), 4u);
  EXPECT_EQ(plan->words[2].text, "tomato");
}

}  // namespace
}  // namespace ssm_test
