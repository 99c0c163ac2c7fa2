// What networks see of a sound: spectra, mel bands and their normalisation, cepstra.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "vdm/features/fourier.h"
#include "vdm/features/level_normaliser.h"
#include "vdm/features/sound_features.h"

namespace vdm {
namespace {

using Sound = std::vector<std::int16_t>;

Sound Tone(double hz, double size, std::size_t samples, double dc = 0) {
  Sound sound(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    sound[i] = static_cast<std::int16_t>(std::lround(
        dc + size * std::sin(2 * std::numbers::pi * hz * static_cast<double>(i) / 16000)));
  }
  return sound;
}

Sound Noise(double size, std::size_t samples) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, size);
  Sound sound(samples);
  for (auto& sample : sound) sample = static_cast<std::int16_t>(std::lround(normal(random)));
  return sound;
}

std::vector<float> Vectors(FeatureKind kind, const Sound& sound, float warp = 1) {
  std::vector<float> vectors;
  MakeFeatures(kind, warp)->Add(sound, vectors);
  return vectors;
}

TEST(FourierTest, ACosineOfAWholeNumberOfTurnsIsInOneBin) {
  std::array<float, 512> cosine;
  for (std::size_t i = 0; i < 512; ++i) {
    cosine[i] =
        static_cast<float>(std::cos(2 * std::numbers::pi * 20 * static_cast<double>(i) / 512));
  }
  const auto power = Fourier512().Power(cosine);
  EXPECT_NEAR(power[20], 256.0F * 256.0F, 1);
  for (std::size_t k = 0; k < power.size(); ++k) {
    if (k == 20) continue;
    EXPECT_NEAR(power[k], 0, 0.01) << k;
  }
}

TEST(FourierTest, TheEnergyIsThatOfTheSamples) {  // Parseval
  std::array<float, 300> samples;
  double energy = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = static_cast<float>((i * 37) % 19) - 9;
    energy += static_cast<double>(samples[i] * samples[i]);
  }
  const auto power = Fourier512().Power(samples);
  double sum = static_cast<double>(power.front()) + static_cast<double>(power.back());
  for (std::size_t k = 1; k + 1 < power.size(); ++k) sum += 2 * static_cast<double>(power[k]);
  EXPECT_NEAR(sum / 512, energy, energy * 1e-5);
}

class FeatureTest : public testing::TestWithParam<FeatureKind> {
 protected:
  void SetUp() override {
    if (auto can = CanMakeFeatures(GetParam()); !can) GTEST_SKIP() << can.error().text;
  }
};

TEST_P(FeatureTest, PiecesOfAnySizeGiveTheSameVectors) {
  const Sound sound = Noise(2000, 16000);
  const std::vector<float> whole = Vectors(GetParam(), sound);
  const auto features = MakeFeatures(GetParam());
  std::vector<float> pieces;
  for (std::size_t at = 0, size = 1; at < sound.size(); at += size, size = size * 3 % 1009) {
    size = std::min(size, sound.size() - at);
    features->Add(std::span(sound).subspan(at, size), pieces);
  }
  EXPECT_EQ(pieces, whole);
  EXPECT_GT(whole.size(), 20 * features->size());
}

TEST_P(FeatureTest, AConstantInTheSoundChangesNothing) {
  // Likelihoods of a tone hang on the click too much; tests/vdm/phone_features_test.cc looks at
  // cepstra.
  if (GetParam() == FeatureKind::kPhones) GTEST_SKIP() << "looked at elsewhere";
  const Sound plain = Tone(440, 5000, 8000), shifted = Tone(440, 5000, 8000, 6000);
  const auto a = Vectors(GetParam(), plain), b = Vectors(GetParam(), shifted);
  const std::size_t size = MakeFeatures(GetParam())->size();
  // The first windows reach into the silence before the sound, where the constant begins: a click,
  // which the mean over the loud frames remembers for a while.
  for (std::size_t i = 4 * size; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 0.5) << i;
}

TEST_P(FeatureTest, AnySoundGivesFiniteNumbers) {
  for (const Sound& sound : {Sound(8000), Sound(8000, 32767), Sound(8000, -32768),
                             Noise(30000, 8000), Tone(8000, 32767, 8000), Tone(50, 1, 8000)}) {
    for (const float value : Vectors(GetParam(), sound)) {
      ASSERT_TRUE(std::isfinite(value));
      ASSERT_LT(std::abs(value), 30);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, FeatureTest,
                         testing::Values(FeatureKind::kMel, FeatureKind::kPhones,
                                         FeatureKind::kCepstra));

TEST(MelFeaturesTest, ATonesBandIsWhereItsFrequencyIs) {
  // Bands are equally wide in mel from 80 to 7200 Hz; 1000 Hz is 1000 mel, so it is band
  // (1000 - 122) / (2731 - 122) * 25 - 1 = 7.4.
  const auto vectors = Vectors(FeatureKind::kMel, Tone(1000, 8000, 16000));
  const auto last = vectors.end() - LevelNormaliser::kSize;
  const auto greatest = std::max_element(last, last + LevelNormaliser::kBands) - last;
  EXPECT_GE(greatest, 7);
  EXPECT_LE(greatest, 8);
}

TEST(MelFeaturesTest, AWarpedSpectrumIsReadElsewhere) {
  const auto plain = Vectors(FeatureKind::kMel, Tone(1000, 8000, 16000));
  const auto warped = Vectors(FeatureKind::kMel, Tone(1200, 8000, 16000), 1.2F);
  for (std::size_t i = plain.size() - LevelNormaliser::kSize; i < plain.size() - 2; ++i) {
    EXPECT_NEAR(plain[i], warped[i], 0.8) << i;
  }
}

TEST(LevelNormaliserTest, LoudAndSoftSpeechLookAlike) {
  const auto run = [](float level) {
    LevelNormaliser normaliser;
    std::vector<float> all;
    for (int t = 0; t < 300; ++t) {
      std::array<float, LevelNormaliser::kBands> bands;
      for (std::size_t b = 0; b < bands.size(); ++b) {
        bands[b] = level + 2 * std::sin(0.3F * static_cast<float>(t) + static_cast<float>(b));
      }
      std::array<float, LevelNormaliser::kSize> out;
      normaliser.Add(bands, out);
      if (t > 100) all.insert(all.end(), out.begin(), out.begin() + LevelNormaliser::kBands);
    }
    return all;
  };
  const auto soft = run(14), loud = run(20);
  for (std::size_t i = 0; i < soft.size(); ++i) EXPECT_NEAR(soft[i], loud[i], 0.2);
}

TEST(LevelNormaliserTest, SilenceIsFarBelowTheSpeechBeforeIt) {
  LevelNormaliser normaliser;
  std::array<float, LevelNormaliser::kBands> bands;
  std::array<float, LevelNormaliser::kSize> out;
  bands.fill(18);
  for (int t = 0; t < 100; ++t) normaliser.Add(bands, out);
  EXPECT_NEAR(out[LevelNormaliser::kBands + 1], 0, 0.1);
  bands.fill(6);
  for (int t = 0; t < 10; ++t) normaliser.Add(bands, out);
  EXPECT_LT(out[LevelNormaliser::kBands + 1], -3.5);
  EXPECT_LT(out[3], -4);
}

TEST(CepstraFeaturesTest, AResonanceGivesTheCepstraOfItsPoles) {
  // Noise through one pair of poles r e^{+-i w}: c_n = 2 r^n cos(n w) / n (Oppenheim and Schafer).
  const double r = 0.9, w = 0.8;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 300);
  Sound sound(16000);
  double y1 = 0, y2 = 0;
  for (auto& sample : sound) {
    const double y = normal(random) + 2 * r * std::cos(w) * y1 - r * r * y2;
    y2 = y1, y1 = y;
    sample = static_cast<std::int16_t>(std::lround(y));
  }
  const auto vectors = Vectors(FeatureKind::kCepstra, sound);
  for (std::size_t n = 1; n <= 4; ++n) {
    double mean = 0;
    std::size_t count = 0;
    for (std::size_t i = 20 + n; i < vectors.size(); i += 20, ++count) {
      mean += static_cast<double>(vectors[i]) / (1.5 * std::sqrt(static_cast<double>(n)));
    }
    const auto order = static_cast<double>(n);
    EXPECT_NEAR(mean / static_cast<double>(count),
                2 * std::pow(r, order) * std::cos(order * w) / order, 0.1)
        << n;
  }
}

}  // namespace
}  // namespace vdm
