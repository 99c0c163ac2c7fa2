// What is said in recordings, without their text.

#include "srm/align/speech_guesser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "sound/sound_file.h"

namespace {

using srm::Millis;

std::vector<std::pair<long, long>> Pieces(const vm::PhonemeList& phonemes, long longest) {
  std::vector<std::pair<long, long>> pieces;
  for (const auto& piece : srm::PiecesOf(phonemes, Millis(longest)))
    pieces.emplace_back(piece.start.count(), piece.end.count());
  return pieces;
}

TEST(SoundPiecesTest, ASoundIsCutInTheLastPauseThatIsNearEnough) {
  using Pairs = std::vector<std::pair<long, long>>;
  const vm::PhonemeList said = {{"aa", Millis(400)},  {"pau", Millis(100)}, {"b", Millis(300)},
                                {"pau", Millis(100)}, {"iy", Millis(500)},  {"pau", Millis(60)}};
  EXPECT_EQ(Pieces(said, 5000), (Pairs{{0, 1460}}));
  EXPECT_EQ(Pieces(said, 1000), (Pairs{{0, 850}, {850, 1460}}));
  EXPECT_EQ(Pieces(said, 500), (Pairs{{0, 450}, {450, 850}, {850, 1350}, {1350, 1460}}));
  EXPECT_EQ(Pieces({}, 500), Pairs{});
}

class SpeechGuesserTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path file =
        "/usr/share/pocketsphinx/test/data/librivox/sense_and_sensibility_01_austen_64kb-0930.wav";
    if (!std::filesystem::exists(file)) {
      GTEST_SKIP() << "the recordings are not installed (pocketsphinx-testdata)";
    }
    auto opened = srm::SpeechGuesser::Open(srm::PocketsphinxOptions().model);
    if (!opened) GTEST_SKIP() << opened.error().text;
    guesser_ = std::move(*opened);
    auto read = sound::ReadSound(file);
    ASSERT_TRUE(read) << read.error().text;
    sound_ = std::move(*read);
  }
  /// "he might even have been made amiable himself" is said in it.
  std::vector<std::int16_t> sound_;
  std::unique_ptr<srm::SpeechGuesser> guesser_;
};

TEST_F(SpeechGuesserTest, WordsOfAPersonAreRecognisedWithTheirTimes) {
  const srm::Alignment said = guesser_->Guess(sound_);
  EXPECT_EQ(vm::TotalDuration(said.phonemes).count(), static_cast<long>(sound_.size() / 16));
  const auto word = [&](const std::string& text) {
    const auto found = std::ranges::find(said.words, text, &srm::HeardWord::text);
    return found == said.words.end() ? srm::HeardWord{.confidence = 0} : *found;
  };
  for (const char* text : {"might", "even", "made", "himself"}) {
    EXPECT_GT(word(text).confidence, 0.9) << text;
  }
  EXPECT_NEAR(static_cast<double>(word("made").start.count()), 1318, 60) << "by its text: 1318";
}

TEST_F(SpeechGuesserTest, SpeechPlayedBackwardsHasPhonemesAndNoWords) {
  std::ranges::reverse(sound_);
  const srm::Alignment said = guesser_->Guess(sound_);
  EXPECT_TRUE(said.words.empty()) << said.words[0].text;
  EXPECT_GT(said.phonemes.size(), 10U);
  EXPECT_EQ(vm::TotalDuration(said.phonemes).count(), static_cast<long>(sound_.size() / 16));
}

TEST_F(SpeechGuesserTest, PiecesOfALongRecordingFollowOneAnother) {
  std::vector<std::int16_t> twice = sound_;
  while (twice.size() < 25U * 16000) twice.insert(twice.end(), sound_.begin(), sound_.end());
  const srm::Alignment said = guesser_->Guess(twice);
  EXPECT_EQ(vm::TotalDuration(said.phonemes).count(), static_cast<long>(twice.size() / 16));
  const auto made = std::ranges::count(said.words, "made", &srm::HeardWord::text);
  EXPECT_EQ(static_cast<std::size_t>(made), twice.size() / sound_.size());
  EXPECT_TRUE(std::ranges::is_sorted(said.words, {}, &srm::HeardWord::start));
}

TEST(SpeechGuesserModelTest, AFolderWithoutAModelIsNamed) {
  const auto opened = srm::SpeechGuesser::Open("/nowhere");
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().text.find("/nowhere"), std::string::npos);
}

}  // namespace
