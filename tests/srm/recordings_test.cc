// Recordings of people, from Debian's pocketsphinx-testdata, with the grammars that come with them.
// Skipped where it is not installed.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "sound/sound_file.h"
#include "tests/srm/speech_world.h"

namespace {

using namespace speech_world;

class RecordingsTest : public RecognitionTest {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kFolder / "goforward.raw")) {
      GTEST_SKIP() << "the recordings are not installed (pocketsphinx-testdata)";
    }
    RecognitionTest::SetUp();
  }
  void UseFile(const char* name) {
    std::ifstream file(kFolder / name);
    Use(std::string{std::istreambuf_iterator<char>(file), {}});
  }
  srm::Hypothesis HearFile(const std::string& name) {
    auto samples = sound::ReadSound(kFolder / name);
    EXPECT_TRUE(samples) << (samples ? "" : samples.error().text);
    return samples ? Hear(*samples) : srm::Hypothesis{};
  }
  const std::filesystem::path kFolder = "/usr/share/pocketsphinx/test/data";
};

TEST_F(RecordingsTest, ACommandIsHeardWordForWordAndCounts) {
  UseFile("goforward.gram");
  const auto heard = HearFile("goforward.raw");
  EXPECT_EQ(heard.text, "go forward ten meters");
  EXPECT_GT(heard.confidence, 0.5);
  ASSERT_EQ(heard.words.size(), 4u);
  EXPECT_NEAR(static_cast<double>(heard.words[1].start.count()), 630, 60) << "said from 0.63 s on";
}

// 001 begins in the middle of its first word, which is heard as one word more.
TEST_F(RecordingsTest, NamesOfCardsAreHeard) {
  UseFile("cards/cards.gram");
  EXPECT_EQ(HearFile("cards/002.wav").text, "four queen of clubs");
  EXPECT_EQ(HearFile("cards/003.wav").text, "seven of clubs");
  EXPECT_EQ(HearFile("cards/004.wav").text, "five five");
  EXPECT_EQ(HearFile("cards/005.wav").text, "eight of spades four of clubs seven of hearts");
}

}  // namespace
