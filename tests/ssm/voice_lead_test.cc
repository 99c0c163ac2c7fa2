// Text.lead: the silence before the first sound.

#include <algorithm>
#include <cstdlib>

#include "ssm/voice/lead.h"
#include "ssm/voice/wav_file.h"
#include "tests/ssm/voice_suite.h"
#include "tests/support/process.h"

namespace ssm_test {
namespace {

class VoiceLeadTest : public VoiceSuite {
 protected:
  std::vector<std::int16_t> Sound() {
    world_.Tell("set SaveWAV = " + (folder_ / "s.wav"));
    return ssm::ReadWav(folder_ / "s.wav").value();
  }
  /// The first sample that is loud.
  static long FirstLoud(const std::vector<std::int16_t>& sound) {
    return std::ranges::find_if(sound, [](int sample) { return std::abs(sample) > 2000; }) -
           sound.begin();
  }
  support::TempDir folder_;
};
INSTANTIATE_TEST_SUITE_P(Engines, VoiceLeadTest, AllEngines(), EngineName);

TEST_P(VoiceLeadTest, TheSilenceBeforeTheFirstSoundIsCutAndNothingElse) {
  const long natural = Prepare();
  const auto whole = Sound();
  const auto before = vm::ParsePhonemes(world_.Ask("Text.pho"));
  ASSERT_TRUE(before);
  ASSERT_EQ(before->front().name, "pau");
  const long first = before->front().duration.count();
  ASSERT_GT(first, 30);
  world_.Tell("set Text.lead = 30");
  EXPECT_EQ(Prepare(), natural - (first - 30));
  const auto cut = Sound();
  ASSERT_LT(cut.size(), whole.size());
  // The noise of the engine differs from one rendering to the next; the stub is silent.
  EXPECT_NEAR(static_cast<double>(FirstLoud(whole) - FirstLoud(cut)),
              static_cast<double>(whole.size() - cut.size()), 320);
  const auto after = vm::ParsePhonemes(world_.Ask("Text.pho"));
  ASSERT_TRUE(after);
  EXPECT_EQ(after->front().duration.count(), 30);
  EXPECT_TRUE(std::equal(after->begin() + 1, after->end(), before->begin() + 1, before->end()));
  world_.Tell("set Text.lead = 0");
  EXPECT_EQ(Prepare(), natural - first);
}

TEST_P(VoiceLeadTest, PausesThatWereAskedForAndTextsThatFollowKeepTheirs) {
  const long asked = Prepare("<SILENCE MSEC=\"500\"/>Hello.");
  const long natural = Prepare("Hello.");
  world_.Tell("set Text.lead = 0");
  EXPECT_EQ(Prepare("<SILENCE MSEC=\"500\"/>Hello."), asked);
  EXPECT_LT(Prepare("Hello."), natural);
  world_.Tell("set Speak = NOW");
  world_.Tell("set Text.next = Hello.");
  world_.UntilIdle();
  EXPECT_EQ(std::stol(world_.Ask("Text.dur")), natural);
}

TEST_P(VoiceLeadTest, WordsAndMarksMoveWithTheSound) {
  Prepare("Hello <BOOKMARK MARK=\"here\"/>there.");
  world_.Tell("prop Speak.mark = AutoOutput");
  world_.Tell("set Speak = NOW");
  world_.UntilIdle();
  const double natural = world_.When("rep Speak.mark = here");
  world_.Tell("set Text.lead = 0");
  const auto pause = vm::ParsePhonemes(world_.Ask("Text.pho"))->front().duration.count();
  Prepare("Hello <BOOKMARK MARK=\"here\"/>there.");
  const double began = world_.Now();
  world_.Tell("set Speak = NOW");
  world_.UntilIdle();
  EXPECT_EQ(world_.When("rep Speak.mark = here") - began, natural - static_cast<double>(pause));
}

TEST(CutLeadTest, APauseAloneStaysAndAMarkBeforeTheSoundComesAtOnce) {
  using ssm::Millis;
  ssm::SpeechPlan plan{.phonemes = {{"pau", Millis(10)}}};
  EXPECT_EQ(ssm::CutLead(plan, Millis(0)), Millis(0));
  plan = {.phonemes = {{"sil", Millis(200)}, {"a", Millis(50)}},
          .words = {{"a", Millis(200), Millis(250)}},
          .marks = {{"m", Millis(0)}, {"n", Millis(200)}}};
  EXPECT_EQ(ssm::CutLead(plan, Millis(300)), Millis(0));
  EXPECT_EQ(ssm::CutLead(plan, Millis(60)), Millis(140));
  EXPECT_EQ(plan.words[0], (ssm::WordTime{"a", Millis(60), Millis(110)}));
  EXPECT_EQ(plan.marks[0].at, Millis(0));
  EXPECT_EQ(plan.marks[1].at, Millis(60));
  EXPECT_EQ(ssm::CutLead(plan, Millis(0)), Millis(60));
  EXPECT_EQ(plan.phonemes.size(), 1u);
}

}  // namespace
}  // namespace ssm_test
