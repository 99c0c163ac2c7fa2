// Discriminant functions: learned, written, read, and used on phrases.

#include "vdm/prosody/discriminant.h"

#include <gtest/gtest.h>

#include <random>

#include "vdm/prosody/emotion_reader.h"

namespace vdm {
namespace {

std::vector<Example> Examples(double apart) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  std::vector<Example> examples;
  for (int n = 0; n < 200; ++n) {
    for (const int side : {-1, 0, 1}) {
      // The two features go together: only their difference tells.
      const double common = 3 * normal(random);
      Eigen::VectorXd features(2);
      features << common + side * apart + 0.3 * normal(random), common + 0.3 * normal(random);
      examples.push_back({side < 0 ? "low" : side > 0 ? "high" : "neutral", features});
    }
  }
  return examples;
}

Discriminant Learned(double apart) {
  return LearnDiscriminant({"a", "b"}, {"neutral", "high", "low"}, Examples(apart)).value();
}

TEST(DiscriminantTest, ItTellsApartWhatOnlyADifferenceTells) {
  const Discriminant functions = Learned(2);
  int right = 0, all = 0;
  for (const Example& example : Examples(2)) {
    const auto likely = functions.Likelihoods(example.features);
    EXPECT_NEAR(likely[0] + likely[1] + likely[2], 1, 1e-9);
    const auto best = std::ranges::max_element(likely) - likely.begin();
    right += functions.classes[static_cast<std::size_t>(best)].name == example.label;
    ++all;
  }
  EXPECT_GT(right, all * 97 / 100);
}

TEST(DiscriminantTest, LikelihoodsAreThoseOfTheNormalDistribution) {
  // One feature, deviation 1, means -1 and 1: the odds at x are exp(2 x).
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::vector<Example> examples;
  for (int n = 0; n < 20000; ++n) {
    examples.push_back(
        {n % 2 ? "up" : "down", Eigen::VectorXd::Constant(1, (n % 2 ? 1 : -1) + normal(random))});
  }
  const auto functions = LearnDiscriminant({"x"}, {"down", "up"}, examples).value();
  for (const double x : {-0.5, 0.0, 0.8}) {
    const auto likely = functions.Likelihoods(Eigen::VectorXd::Constant(1, x));
    EXPECT_NEAR(likely[1], 1 / (1 + std::exp(-2 * x)), 0.02) << x;
  }
}

TEST(DiscriminantTest, WhatIsWrittenIsReadAgain) {
  const Discriminant functions = Learned(1);
  const std::string text = FormatDiscriminant(functions);
  const auto read = ParseDiscriminant("a.txt", text);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(FormatDiscriminant(*read), text);
  const Eigen::VectorXd there = Eigen::VectorXd::Constant(2, 0.7);
  EXPECT_NEAR(read->Likelihoods(there)[1], functions.Likelihoods(there)[1], 1e-4);
}

TEST(DiscriminantTest, BadTablesAreRefusedWithTheirLine) {
  const auto error = [](const std::string& text) {
    const auto read = ParseDiscriminant("t", text);
    return read ? std::string("none") : read.error().text;
  };
  EXPECT_EQ(error(""), "t:0: features NAME... with 1 to 16 names expected");
  EXPECT_EQ(error("features a\n"), "t:1: the end found, 'most' expected");
  EXPECT_EQ(error("features a\nmost x\n"),
            "t:2: 'x' found, a number from -10000 to 10000 expected");
  EXPECT_EQ(error("features a\nmost -1\n"), "t:2: a number below 0 found after 'most'");
  EXPECT_EQ(error("features a\nmost 1\nclass n 0 1 2\n"),
            "t:3: class NAME CONSTANT and 1 weights expected");
  EXPECT_EQ(error("features a\nmost 1\n# one\nclass n 0 nan\n"),
            "t:4: 'nan' found, a number from -10000 to 10000 expected");
  EXPECT_EQ(error("features a\nmost 1\nclass n 0 1\n"), "t:3: fewer than two classes found");
  EXPECT_EQ(error("features a\nmost 1\nclass n 0 1\nclass m 0 1\n"), "none");
}

TEST(DiscriminantTest, TooFewExamplesAndUnknownLabelsAreRefused) {
  const Example one{"neutral", Eigen::VectorXd::Zero(1)};
  EXPECT_EQ(LearnDiscriminant({"a"}, {"neutral"}, {one, one}).error().text,
            "2 phrases of neutral found, at least 3 expected");
  EXPECT_EQ(LearnDiscriminant({"a"}, {"low"}, {one}).error().text,
            "label 'neutral' found, low expected");
}

/// A stream of made speech: the prosody is told by hand, through a voice of known pitch.
class EmotionReaderTest : public testing::Test {
 protected:
  void Speak(double hz, double size, std::size_t ms) {
    std::vector<std::int16_t> sound(16 * ms);
    double phase = 0;
    for (std::size_t i = 0; i < sound.size(); ++i) {
      const double t = static_cast<double>(i) / 16000;
      // Two semitones up and down, twice a second.
      phase += 6.283185307 / 16000 * hz * std::pow(2, std::sin(12.566 * t) / 6);
      double x = 0;
      for (int k = 1; k < 20; ++k) x += std::sin(k * phase) / k;
      const double syllable = 0.2 + std::pow(std::sin(3.14159265 * 4.5 * t), 2);
      sound[i] = static_cast<std::int16_t>(std::lround(size * syllable * x));
    }
    Hear(sound, 1);
    Hear(std::vector<std::int16_t>(16 * 400), 0);
  }
  void Hear(const std::vector<std::int16_t>& sound, float speech) {
    stream_.Add(sound);
    for (std::size_t end = heard_ + sound.size(); heard_ < end; heard_ += 160) {
      stream_.Advance(heard_, speech, [&](const ProsodyFrame& frame) {
        if (reader_.Add(frame, stream_)) ++changes_;
        if (auto now = meter_.Add(frame, stream_)) measured_.push_back(*now);
      });
    }
  }
  ProsodyStream stream_{960};
  EmotionReader reader_{ShippedEmotions()};
  PhraseMeter meter_;
  std::vector<Eigen::VectorXd> measured_;
  std::uint64_t heard_ = 0;
  int changes_ = 0;
};

TEST_F(EmotionReaderTest, NothingIsClaimedBeforeTheVoiceIsKnown) {
  Speak(120, 1500, 1500);
  EXPECT_EQ(changes_, 0);
  EXPECT_TRUE(reader_.likelihoods().empty());
}

TEST_F(EmotionReaderTest, PhrasesAreMeasuredBesideTheUsual) {
  for (int n = 0; n < 8; ++n) Speak(120, 1500, 1500);
  ASSERT_FALSE(measured_.empty());
  EXPECT_NEAR(measured_.back()[0], 0, 0.2);  // semitones
  EXPECT_NEAR(measured_.back()[2], 0, 1);    // dB
  EXPECT_NEAR(measured_.back()[4], 0, 0.15);
  Speak(120 * std::pow(2, 4.0 / 12), 3000, 1500);
  EXPECT_NEAR(measured_.back()[0], 4, 0.8);
  EXPECT_NEAR(measured_.back()[2], 6, 1.5);
  EXPECT_GT(changes_, 3);
}

TEST_F(EmotionReaderTest, AHigherLouderVoiceIsArousedALowerSofterOneLowAndSilenceNothing) {
  for (int n = 0; n < 8; ++n) Speak(120, 1500, 1500);
  const auto best = [&] {
    const auto& likely = reader_.likelihoods();
    if (likely.empty()) return std::string("none");
    const auto at = std::ranges::max_element(likely) - likely.begin();
    return ShippedEmotions().classes[static_cast<std::size_t>(at)].name;
  };
  EXPECT_EQ(best(), "neutral");
  for (int n = 0; n < 2; ++n) Speak(120 * 1.2, 2100, 1300);
  EXPECT_EQ(best(), "aroused");
  for (int n = 0; n < 4; ++n) Speak(120, 1500, 1500);
  for (int n = 0; n < 2; ++n) Speak(120 * 0.88, 950, 1900);
  EXPECT_EQ(best(), "low");
  Hear(std::vector<std::int16_t>(16 * 5000), 0);
  EXPECT_EQ(best(), "none");
}

}  // namespace
}  // namespace vdm
