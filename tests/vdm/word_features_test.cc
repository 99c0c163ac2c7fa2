// What words tell of a voice, with the installed model.

#include "vdm/words/word_features.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/vdm/spoken.h"
#include "vdm/mouth/mouth_tracker.h"
#include "vm_protocol/core/lower_case.h"

namespace vdm {
namespace {

std::string PhoneAt(const Take& said, double ms) {
  for (const vm::Phoneme& phoneme : said.phonemes) {
    if (ms < static_cast<double>(phoneme.duration.count())) return phoneme.name;
    ms -= static_cast<double>(phoneme.duration.count());
  }
  return "pau";
}

class WordFeaturesTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto can = CanMakeFeatures(FeatureKind::kWords); !can)
      GTEST_SKIP() << can.error().text;
  }
};

TEST_F(WordFeaturesTest, WordsTellPhonesThatFramesByThemselvesDoNot) {
  const Take said = Spoken("The weather in the mountains will be wonderful tomorrow morning.");
  const auto& names = (*InstalledPhoneModel())->phones();
  // Of the frames that are no pause, the share whose likeliest phone is the one being said.
  const auto right = [&](FeatureKind kind, std::size_t first) {
    const auto features = MakeFeatures(kind);
    std::vector<float> vectors;
    features->Add(said.samples, vectors);
    double all = 0, found = 0;
    for (std::size_t k = 0; (k + 1) * features->size() <= vectors.size(); ++k) {
      const std::string phone = PhoneAt(said, 10.0 * static_cast<double>(k));
      if (phone == "pau") continue;
      const auto begin =
          vectors.begin() + static_cast<std::ptrdiff_t>(k * features->size() + first);
      const auto likeliest = std::max_element(begin, begin + PhoneFeatures::kPhones) - begin;
      ++all;
      found += vm::LowerCase(names[static_cast<std::size_t>(likeliest)]) == phone;
    }
    return found / all;
  };
  EXPECT_GT(right(FeatureKind::kWords, 0),
            right(FeatureKind::kPhones, LevelNormaliser::kSize) + 0.05);
}

TEST_F(WordFeaturesTest, PiecesOfAnySizeTellTheSameWithinTheTimeSaid) {
  const Take said = Spoken("Good morning.");
  const auto whole = MakeFeatures(FeatureKind::kWords), pieces = MakeFeatures(FeatureKind::kWords);
  std::vector<float> expected, vectors;
  whole->Add(said.samples, expected);
  ASSERT_EQ(expected.size() % whole->size(), 0U);
  for (std::size_t at = 0; at < said.samples.size(); at += 331) {
    const std::size_t heard = std::min(at + 331, said.samples.size());
    pieces->Add(std::span(said.samples).subspan(at, heard - at), vectors);
    const std::size_t told = vectors.size() / pieces->size();
    if (told == 0) continue;
    EXPECT_LE((told - 1) * pieces->hop_samples() + pieces->ahead_samples(), heard);
    EXPECT_GT(told * pieces->hop_samples() + pieces->ahead_samples(), heard);
  }
  EXPECT_EQ(vectors, expected);
}

TEST_F(WordFeaturesTest, TheNetworkOfWordsHearsNoFurtherAheadThanThatOfPhones) {
  const MouthTracker phones(ShippedNet(FeatureKind::kPhones));
  const MouthTracker both(ShippedNet(FeatureKind::kPhones), 1, &ShippedNet(FeatureKind::kWords));
  EXPECT_EQ(both.ahead_samples(), phones.ahead_samples());
  EXPECT_LE(both.ahead_samples(), 60U * 16U);
}

}  // namespace
}  // namespace vdm
