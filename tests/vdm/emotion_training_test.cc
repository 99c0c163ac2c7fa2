// Lists of labelled recordings, and what is learned of voices that change their manner.

#include "vdm/train/emotion_training.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "vdm/prosody/emotion_reader.h"

namespace vdm {
namespace {

/// A sentence of a kind: syllables of a buzz through the formants of "a".
std::vector<std::int16_t> Voice(double hz, double size, double rate, double seconds) {
  std::vector<std::int16_t> sound(static_cast<std::size_t>(16000 * seconds));
  double phase = 0;
  for (std::size_t i = 0; i < sound.size(); ++i) {
    const double t = static_cast<double>(i) / 16000;
    phase += 6.2831853 / 16000 * hz * std::pow(2, std::sin(9 * t) / 6);  // two semitones
    double x = 0;
    for (int k = 1; k * hz < 4000; ++k) {
      double level = 0;
      for (const double formant : {700.0, 1200.0, 2600.0}) {
        level += 1 / (1 + std::pow((hz * k - formant) / 90, 2));
      }
      x += level * std::sin(k * phase);
    }
    x *= std::pow(std::sin(3.14159265 * t * rate), 2);
    sound[i] = static_cast<std::int16_t>(std::lround(size * x));
  }
  return sound;
}

std::vector<EmotionTake> EmotionTakes() {
  std::vector<EmotionTake> takes;
  for (const auto& [speaker, hz] : {std::pair("he", 110.0), std::pair("she", 200.0)}) {
    for (int n = 0; n < 3; ++n) {
      const double other = 1 + 0.02 * n;
      takes.push_back({speaker, "neutral", Voice(hz * other, 2000, 4, 2.5)});
      takes.push_back({speaker, "aroused", Voice(hz * other * 1.25, 3200, 4.6, 2.5)});
      takes.push_back({speaker, "low", Voice(hz * other * 0.85, 1300, 3.3, 2.5)});
    }
  }
  return takes;
}

TEST(EmotionTrainingTest, MannersBesideTheUsualAreToldApart) {
  std::string said;
  const auto text =
      TeachEmotion(EmotionTakes(), "buzzes", [&](const std::string& line) { said = line; });
  ASSERT_TRUE(text) << text.error().text;
  const auto functions = ParseDiscriminant("t", *text);
  ASSERT_TRUE(functions) << functions.error().text;
  EXPECT_EQ(functions->features, PhraseMeter::FeatureNames());
  ASSERT_EQ(functions->classes.size(), 3U);
  EXPECT_EQ(functions->classes[0].name, "neutral");
  EXPECT_TRUE(said.starts_with("speakers left out: ")) << said;
  const auto examples = MeasureTakes(EmotionTakes());
  ASSERT_TRUE(examples);
  EXPECT_GE(examples->size(), 18U);
  std::size_t right = 0;
  for (const Example& example : *examples) {
    const auto likely = functions->Likelihoods(example.features);
    const auto best = static_cast<std::size_t>(std::ranges::max_element(likely) - likely.begin());
    right += functions->classes[best].name == example.label;
  }
  EXPECT_GE(right, examples->size() * 9 / 10) << "of " << examples->size();
}

TEST(EmotionTrainingTest, ASpeakerWithoutNeutralSpeechIsRefused) {
  auto takes = EmotionTakes();
  std::erase_if(takes,
                [](const auto& take) { return take.speaker == "she" && take.label == "neutral"; });
  const auto text = TeachEmotion(takes, "buzzes", [](const std::string&) {});
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().text,
            "less than 3 s of voice with the label neutral found of speaker 'she'");
}

TEST(EmotionTrainingTest, BadListsAreRefusedWithTheirLine) {
  const auto path =
      std::filesystem::temp_directory_path() / ("emotion_list_" + std::to_string(::getpid()));
  const auto error = [&](const std::string& text) {
    std::ofstream(path) << text;
    const auto takes = ReadEmotionTakes(path.string());
    std::string found = takes ? "none" : takes.error().text;
    if (found.starts_with(path.string())) found.erase(0, path.string().size());
    return found;
  };
  EXPECT_EQ(error("# nothing\n"), ":1: no recording found, WAV LABEL [SPEAKER] expected");
  EXPECT_EQ(error("\na.wav\n"), ":2: WAV LABEL [SPEAKER] expected");
  EXPECT_EQ(error("a.wav b c d\n"), ":1: WAV LABEL [SPEAKER] expected");
  EXPECT_TRUE(error("/no/such.wav neutral\n").starts_with(":1: "))
      << error("/no/such.wav neutral\n");
  std::filesystem::remove(path);
  EXPECT_FALSE(ReadEmotionTakes("/no/such/list"));
}

}  // namespace
}  // namespace vdm
