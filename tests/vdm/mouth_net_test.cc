// The text of a network: what is read is what was written, and damage is told with its line.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/vdm/made_net.h"
#include "vdm/net/sound_classes.h"

namespace vdm {
namespace {

std::string ErrorOf(const std::string& text) {
  const auto read = ParseMouthNet("x.net", text);
  return read ? "(none)" : read.error().text;
}
std::string Changed(const std::string& from, const std::string& to) {
  std::string text = FormatMouthNet(MadeNet());
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(MouthNetTest, WhatIsWrittenIsReadAndWrittenTheSame) {
  const std::string text = FormatMouthNet(MadeNet());
  const auto read = ParseMouthNet("x.net", text);
  ASSERT_TRUE(read) << read.error().text;
  EXPECT_EQ(FormatMouthNet(*read), text);
  EXPECT_EQ(read->net.ahead(), 3U);
  EXPECT_EQ(read->net.behind(), 5U);
  // 8 bits a row: no weight is off by more than half a step of its row.
  const Eigen::MatrixXf made = MadeNet().net.layers[0].weights;
  EXPECT_LT((read->net.layers[0].weights - made).cwiseAbs().maxCoeff(), 0.5F * 0.3F / 127 + 1e-4F);
}

TEST(MouthNetTest, DamageIsToldWithItsLine) {
  const std::string whole = FormatMouthNet(MadeNet());
  EXPECT_EQ(ErrorOf(""), "x.net:0: the end found, 'features' expected");
  EXPECT_EQ(ErrorOf("features smell\n"),
            "x.net:1: 'smell' found, mel, phones, cepstra or words expected");
  EXPECT_NE(ErrorOf("# a comment\nwrong mel\n").find("x.net:2: 'wrong' found, 'features' expected"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Changed("relu", "tanh")).find("x.net:5: 'tanh' found, relu or linear"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Changed("layer 26 7", "layer 26 2000"))
                .find("x.net:5: '2000' found, a number from 1 to 1024"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Changed("-2 0 1", "-2 1 0")).find("offsets that do not rise"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Changed("-2 0 1", "-2 0 65")).find("'65' found, a number from -64 to 64"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Changed("-2 0 1", "-2 0")).find("x.net:6: 78 weights found, 52 expected"),
            std::string::npos);
  const auto with_weights = [&](const char* four_signs) {
    std::string text = whole;
    return text.replace(text.rfind(' ') + 1, 4, four_signs);
  };
  EXPECT_NE(ErrorOf(with_weights("a!bc")).find("weights that are no base64 found"),
            std::string::npos);
  EXPECT_NE(ErrorOf(with_weights("gICA")).find("a weight of -128 found"), std::string::npos);
  EXPECT_NE(
      ErrorOf(Changed("layer 7 5", "layer 8 5")).find("8 inputs found after a layer of 7 outputs"),
      std::string::npos);
  EXPECT_NE(ErrorOf(Changed("sounds sil aa", "sounds sil")).find("21 outputs, 20 expected"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Changed("scales 1.5", "scales 0")).find("a scale below 0.000001 found"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Changed("scales 1.5", "scales nan")).find("'nan' found"), std::string::npos);
  EXPECT_NE(ErrorOf(whole.substr(0, whole.rfind("row"))).find("the end found, 'row' expected"),
            std::string::npos);
  EXPECT_NE(ErrorOf(whole + "row 1 2 3\n").find("'row' found, 'layer' expected"),
            std::string::npos);
}

TEST(MouthNetTest, TheShippedNetworksAreSmallAndSeeAtMost60MsAhead) {
  const MouthNet& mel = ShippedNet(FeatureKind::kMel);
  EXPECT_LT(mel.net.parameters(), 250'000U);
  const auto features = MakeFeatures(FeatureKind::kMel);
  EXPECT_LE(features->ahead_samples() + mel.net.ahead() * features->hop_samples(), 16U * 60);
  const MouthNet& phones = ShippedNet(FeatureKind::kPhones);
  EXPECT_LT(phones.net.parameters(), 550'000U);
  EXPECT_EQ(phones.net.inputs(), FeatureSize(FeatureKind::kPhones));
  // Its features look as far ahead as those of mel (tests/vdm/phone_features_test.cc).
  EXPECT_LE(phones.net.ahead(), mel.net.ahead());
  const MouthNet& cepstra = ShippedNet(FeatureKind::kCepstra);
  EXPECT_EQ(cepstra.net.layers.size(), 2U);  // the papers': 20 in, 20 hidden, out
  EXPECT_EQ(cepstra.net.layers[0].outputs(), 20U);
  EXPECT_EQ(mel.sounds, SoundClasses::Built().names());
}

TEST(SoundClassesTest, WhatStandsTwiceAndWhatIsEmptyIsToldWithItsLine) {
  const auto error = [](const char* text) {
    return SoundClasses::Read("s.txt", text).error().text;
  };
  EXPECT_EQ(error("sil pau\nsil cl\n"), "s.txt:2: the class 'sil' is here twice");
  EXPECT_EQ(error("sil pau\nx pau\n"), "s.txt:2: the phoneme 'pau' is here twice");
  EXPECT_EQ(error("# c\nsil\n"), "s.txt:2: the class 'sil' found without phonemes");
  EXPECT_EQ(error(""), "s.txt:0: no class found, at least one expected");
  EXPECT_EQ(SoundClasses::Built().Of("b"), SoundClasses::Built().Of("my"));
  EXPECT_EQ(SoundClasses::Built().Of("no phoneme"), 0U);
}

}  // namespace
}  // namespace vdm
