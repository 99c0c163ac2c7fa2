// Recordings with their text: when their phonemes are spoken, and which are learned from.

#include "vdm/train/people.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "ssm/voice/wav_file.h"
#include "tests/vdm/spoken.h"
#include "vdm/train/forced_alignment.h"
#include "vdm/train/lesson.h"

namespace vdm {
namespace {

/// Middles of phonemes but pauses, in ms.
std::vector<double> Middles(const vm::PhonemeList& phonemes) {
  std::vector<double> middles;
  double at = 0;
  for (const vm::Phoneme& phoneme : phonemes) {
    const auto length = static_cast<double>(phoneme.duration.count());
    if (phoneme.name != "pau") middles.push_back(at + length / 2);
    at += length;
  }
  return middles;
}

class PeopleTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!CanMakeFeatures(FeatureKind::kPhones)) GTEST_SKIP() << "needs pocketsphinx-en-us";
    std::filesystem::create_directories(folder_);
  }
  ~PeopleTest() override { std::filesystem::remove_all(folder_); }
  std::string List(const std::string& lines) const {
    std::ofstream(folder_ / "list") << lines;
    return folder_ / "list";
  }
  vm::Result<std::vector<Take>> Read(const std::string& lines) {
    return ReadPeople(List(lines), GALATEA_BIN_DIR "/ssm_espeak",
                      [this](const std::string& line) { said_ = line; });
  }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("people" + std::to_string(getpid()));
  std::string said_;
};

TEST_F(PeopleTest, PhonemesAreFoundWhereTheVoiceSpeaksThem) {
  const Take take = Spoken("The old woman bought seven yellow apples at the market.");
  // As another voice would speak them: 80 ms each.
  vm::PhonemeList asked;
  for (const vm::Phoneme& phoneme : take.phonemes) {
    if (phoneme.name != "pau") asked.push_back({phoneme.name, std::chrono::milliseconds(80)});
  }
  const auto found = AlignPhonemes(FeaturesOf(take.samples, FeatureKind::kPhones), asked);
  const auto truth = Middles(take.phonemes), ours = Middles(found.phonemes);
  ASSERT_EQ(ours.size(), truth.size());
  double off = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) off += std::abs(ours[i] - truth[i]);
  EXPECT_LT(off / static_cast<double>(truth.size()), 30);
  EXPECT_GT(found.fit, -1.3);
}

TEST_F(PeopleTest, ASoundTooShortForItsPhonemesHasNoAlignment) {
  const Take take = Spoken("Yes.");
  const vm::PhonemeList many(100, {"aa", std::chrono::milliseconds(80)});
  EXPECT_TRUE(AlignPhonemes(FeaturesOf(take.samples, FeatureKind::kPhones), many).phonemes.empty());
}

TEST_F(PeopleTest, RecordingsThatSayWhatTheirTextSaysAreLearnedFrom) {
  if (!std::filesystem::exists(GALATEA_BIN_DIR "/ssm_espeak")) GTEST_SKIP() << "needs ssm_espeak";
  const Take apples = Spoken("The old woman bought seven yellow apples.");
  ASSERT_TRUE(ssm::WriteWav(folder_ / "apples.wav", apples.samples));
  const auto takes = Read(
      "apples.wav\ten\tThe old woman bought seven yellow apples.\n"
      "apples.wav\ten\tNobody wishes to hear about this trip.\n");
  ASSERT_TRUE(takes) << takes.error().text;
  EXPECT_EQ(said_, "1 recordings of people; 1 more do not fit their text");
  ASSERT_EQ(takes->size(), 1U);
  EXPECT_EQ(takes->front().voice, "people-en");
  EXPECT_EQ(vm::TotalDuration(takes->front().phonemes).count() * 16,
            static_cast<std::int64_t>(takes->front().samples.size()));
}

TEST_F(PeopleTest, AListOfWhichNothingFitsIsAnError) {
  if (!std::filesystem::exists(GALATEA_BIN_DIR "/ssm_espeak")) GTEST_SKIP() << "needs ssm_espeak";
  ASSERT_TRUE(ssm::WriteWav(folder_ / "apples.wav", Spoken("Seven yellow apples.").samples));
  const auto takes = Read("apples.wav\ten\tNobody wishes to hear about this trip.\n");
  ASSERT_FALSE(takes);
  EXPECT_EQ(takes.error().text,
            (folder_ / "list").string() + ": no recording found that fits its text");
}

TEST_F(PeopleTest, AListThatIsWrongIsToldWithItsLine) {
  EXPECT_EQ(Read("no tabs here\n").error().text,
            (folder_ / "list").string() + ":1: FILE, LANGUAGE and TEXT between tabs expected");
  EXPECT_EQ(Read("none.wav\ten\tHello.\n").error().code, vm::Errc::kUnavailable);
}

}  // namespace
}  // namespace vdm
