// The mouth of a recording whose words are known.

#include "vdm/recording/recorded_mouth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "sound/sound_file.h"
#include "vdm/mouth/mouth_tracker.h"
#include "vdm/recording/recording_reader.h"

namespace vdm {
namespace {

MouthFrame Heard(float jaw, float silence) {
  MouthFrame frame;
  frame.mouth[11] = jaw;
  frame.seal = 0;
  frame.sounds = {silence, 1 - silence};
  return frame;
}

RecordedMouth KnownShut(float trust) {
  RecordedMouth known;
  known.instants.push_back({.trust = trust});  // at rest
  return known;
}

TEST(RecordedMouthTest, WordsHaveTheirShareByTheirTrust) {
  MouthFrame frame = Heard(8, 0);
  KnownShut(0.75F).Blend(159, frame);
  EXPECT_FLOAT_EQ(frame.mouth[11], 2);
  EXPECT_FLOAT_EQ(frame.seal, 0.75F);
}

TEST(RecordedMouthTest, WhereTheNetworkHearsNothingSaidWordsCountForNothing) {
  MouthFrame frame = Heard(8, 1);
  KnownShut(1).Blend(0, frame);
  EXPECT_FLOAT_EQ(frame.mouth[11], 8);
}

TEST(RecordedMouthTest, BehindTheRecordingTheNetworkGoesOn) {
  MouthFrame frame = Heard(8, 0);
  KnownShut(1).Blend(RecordedMouth::kHopSamples, frame);
  EXPECT_FLOAT_EQ(frame.mouth[11], 8);
}

/// "five five": the teeth touch the lower lip four times, which the network may miss.
TEST(RecordingReaderTest, WordsOfAPersonMoveTheMouthBeforeTheyAreHeard) {
  const std::filesystem::path file = "/usr/share/pocketsphinx/test/data/cards/004.wav";
  if (!std::filesystem::exists(file)) {
    GTEST_SKIP() << "the recordings are not installed (pocketsphinx-testdata)";
  }
  const auto reader = RecordingReader::Open();
  if (!reader) GTEST_SKIP() << reader.error().text;
  const auto samples = sound::ReadSound(file);
  ASSERT_TRUE(samples) << samples.error().text;
  const RecordedMouth words = (*reader)->Read(*samples);
  EXPECT_EQ(words.text, "five five");
  ASSERT_EQ(words.instants.size(), samples->size() / RecordedMouth::kHopSamples);
  const auto widest = std::ranges::max_element(
      words.instants, {}, [](const auto& instant) { return instant.frame.Opening(); });
  EXPECT_GT(widest->trust, 0.9F);
  EXPECT_GT(widest->frame.Opening(), 6);
}

}  // namespace
}  // namespace vdm
