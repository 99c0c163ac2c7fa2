// The acoustic model's likelihoods: a model by hand, damage, and what the installed one hears.

#include "vdm/features/phone_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "tests/vdm/hand_model.h"

namespace vdm {
namespace {

TEST(PhoneModelTest, LikelihoodsAreThoseOfTheFormula) {
  const HandModel hand({"AA", "SIL"}, "vdm_phone_model");
  const auto model = PhoneModel::Read(hand.folder);
  ASSERT_TRUE(model) << model.error().text;
  EXPECT_EQ((*model)->phones(), (std::vector<std::string>{"AA", "SIL"}));
  // 40 columns, more than are computed together; x = column / 10 everywhere.
  Eigen::MatrixXf features(39, 40);
  for (int c = 0; c < 40; ++c) features.col(c).setConstant(0.1F * static_cast<float>(c));
  const Eigen::MatrixXf states = (*model)->Score(features);
  ASSERT_EQ(states.rows(), 6);
  for (int c = 0; c < 40; ++c) {
    for (int phone = 0; phone < 2; ++phone) {
      double sum = 0;
      for (int stream = 0; stream < 3; ++stream) {
        const double variance = 1 + stream, d = 0.1 * c - phone - stream;
        sum += 13 * -0.5 * (std::log(2 * std::numbers::pi * variance) + d * d / variance);
      }
      EXPECT_NEAR(states(3 * phone, c), sum, 2e-3) << c;
      const double weight = phone == 0 ? 3 * 10 * 1024 * std::log(1.0001) : 0;
      EXPECT_NEAR(states(3 * phone + 1, c), sum - weight, 2e-3) << c;
    }
  }
  // A column does not depend on those beside it.
  EXPECT_EQ((*model)->Score(features.col(33)), states.col(33));
}

TEST(PhoneModelTest, DamageIsToldWithTheFile) {
  const HandModel hand({"AA", "SIL"}, "vdm_phone_model");
  const auto error = [&] { return PhoneModel::Read(hand.folder).error().text; };
  const std::string folder = hand.folder.string();
  hand.Weights(7);
  EXPECT_EQ(error(), folder +
                         "/sendump: weights of 32 densities in 6 states expected, without "
                         "clusters");
  hand.Gaussians("variances", [](auto, auto, auto) { return NAN; });
  EXPECT_EQ(error(), folder + "/variances: a value that is no number found");
  hand.Gaussians(
      "means", [](auto, auto, auto) { return 0.0F; }, 4);
  EXPECT_NE(error().find("/means: a codebook for each phone"), std::string::npos) << error();
  hand.Write("means", "s3\nendhdr\n");
  EXPECT_NE(error().find("/means: no file of Gaussians"), std::string::npos) << error();
  hand.Definition("BMDG");
  EXPECT_EQ(error(), folder + "/mdef: no binary model definition of version 1 found");
  std::filesystem::remove(hand.folder / "mdef");
  EXPECT_NE(error().find("cannot read '" + folder + "/mdef'"), std::string::npos);
}

TEST(SpeechCepstraTest, AConstantInTheSoundChangesNothing) {
  std::vector<std::int16_t> plain(SpeechCepstra::kWindow), shifted;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    plain[i] = static_cast<std::int16_t>(5000 * std::sin(0.0005 * static_cast<double>(i * i)));
  }
  for (const std::int16_t sample : plain) {
    shifted.push_back(static_cast<std::int16_t>(sample + 6000));
  }
  const auto a = SpeechCepstra().Of(0, plain), b = SpeechCepstra().Of(6000, shifted);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 0.05) << i;
}

TEST(PhoneFeaturesTest, NothingFurtherAheadThanMelIsHeard) {
  if (auto can = CanMakeFeatures(FeatureKind::kPhones); !can) GTEST_SKIP() << can.error().text;
  const auto features = MakeFeatures(FeatureKind::kPhones);
  EXPECT_EQ(features->ahead_samples(), MakeFeatures(FeatureKind::kMel)->ahead_samples());
  std::vector<std::int16_t> sound(16000);
  for (std::size_t i = 0; i < sound.size(); ++i) {
    sound[i] =
        static_cast<std::int16_t>(5000 * std::sin(0.001 * static_cast<double>(i * i % 9973)));
  }
  // Vector k is there as soon as ahead_samples() beyond its own have come, no later.
  std::vector<float> vectors;
  for (std::size_t at = 0; at < sound.size(); at += 40) {
    features->Add(std::span(sound).subspan(at, 40), vectors);
    const std::size_t came = at + 40, ahead = features->ahead_samples();
    EXPECT_EQ(vectors.size() / features->size(), came < ahead ? 0 : (came - ahead) / 160 + 1);
  }
}

TEST(PhoneFeaturesTest, AHissIsAFricativeAndABuzzIsNone) {
  const auto model = InstalledPhoneModel();
  if (!model) GTEST_SKIP() << model.error().text;
  std::vector<std::int16_t> sound(48000);
  std::uint32_t state = 7;
  double last = 0;
  for (std::size_t i = 16000; i < 32000; ++i) {  // noise whose lows are taken out, as of an s
    state = state * 1664525U + 1013904223U;
    const double noise = static_cast<double>(state >> 8) / (1 << 23) - 1;
    sound[i] = static_cast<std::int16_t>(2500 * (noise - last));
    last = noise;
  }
  for (std::size_t i = 36000; i < sound.size();
       ++i) {  // harmonics round 700 and 1150 Hz, as of an a
    double x = 0;
    for (int k = 1; k < 30; ++k) {
      const double low = (110 * k - 700) / 90.0, high = (110 * k - 1150) / 90.0;
      x += (1 / (1 + low * low) + 0.7 / (1 + high * high)) *
           std::sin(6.2831853 * 110 * k * static_cast<double>(i) / 16000);
    }
    sound[i] = static_cast<std::int16_t>(3000 * x);
  }
  std::vector<float> vectors;
  MakeFeatures(FeatureKind::kPhones)->Add(sound, vectors);
  const auto likeliest = [&](std::size_t vector) {
    const auto first = vectors.begin() + static_cast<std::ptrdiff_t>(vector * PhoneFeatures::kSize +
                                                                     LevelNormaliser::kSize);
    return (*model)->phones()[static_cast<std::size_t>(
        std::max_element(first, first + PhoneFeatures::kPhones) - first)];
  };
  const std::string hiss = likeliest(150);
  EXPECT_TRUE(hiss == "S" || hiss == "SH" || hiss == "Z" || hiss == "CH" || hiss == "T") << hiss;
  const std::string buzz = likeliest(280);
  EXPECT_TRUE(buzz.starts_with("A") || buzz == "OW") << buzz;
}

}  // namespace
}  // namespace vdm
