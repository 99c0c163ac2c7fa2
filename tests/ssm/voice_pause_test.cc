// Pause and resume, the next text, emotion, markup and label files: what is ours beside the
// original's.

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/ssm/voice_suite.h"
#include "tests/support/process.h"

namespace ssm_test {
namespace {

class VoicePauseTest : public VoiceSuite {};
INSTANTIATE_TEST_SUITE_P(Engines, VoicePauseTest, AllEngines(), EngineName);

TEST_P(VoicePauseTest, APauseKeepsThePlaceAndResumeGoesOnFromIt) {
  const long length = Prepare();
  world_.Tell("set Speak = NOW");
  world_.Pass(1500);
  world_.Lines();
  world_.Tell("set Speak = PAUSE");
  EXPECT_EQ(world_.Lines(), (Lines{"rep Speak.stat = PAUSED"}));
  world_.Pass(5000);
  EXPECT_EQ(world_.Ask("Speak.len"), "1500");
  EXPECT_EQ(world_.Lines(), Lines{});
  world_.Tell("set Speak = RESUME");
  world_.said.clear();
  const double resumed = world_.Now();
  world_.UntilIdle();
  EXPECT_DOUBLE_EQ(world_.When("tell Speak.sync = 2500") - resumed, 1000);
  EXPECT_NEAR(world_.When("rep Speak.stat = IDLE") - resumed, static_cast<double>(length - 1500),
              1);
  EXPECT_EQ(world_.Ask("Speak.len"), std::to_string(length));
}

TEST_P(VoicePauseTest, WordsAfterAPauseKeepTheirNumbersAndTimes) {
  world_.Tell("prop Speak.word = AutoOutput");
  Prepare();
  world_.Tell("set Speak = NOW");
  world_.UntilIdle();
  const auto words = [&] {
    Lines only;
    for (const std::string& line : world_.Lines()) {
      if (line.starts_with("rep Speak.word")) only.push_back(line);
    }
    return only;
  };
  const Lines whole = words();
  world_.Tell("set Speak = NOW");
  world_.Pass(1000);
  world_.Tell("set Speak = PAUSE");
  world_.Pass(300);
  world_.Tell("set Speak = RESUME");
  world_.UntilIdle();
  EXPECT_EQ(words(), whole);
}

TEST_P(VoicePauseTest, StopWhilePausedTellsThePartSpoken) {
  Prepare();
  world_.Tell("set Speak = NOW");
  world_.Pass(700);
  world_.Tell("set Speak = PAUSE");
  world_.Lines();
  world_.Tell("set Speak = STOP");
  const Lines said = world_.Lines();
  ASSERT_EQ(said.size(), 3u);
  EXPECT_EQ(said[0], "rep Speak.len = 700");
  EXPECT_EQ(said[2], "rep Speak.stat = IDLE");
}

TEST_P(VoicePauseTest, WhatMakesNoSenseNowIsBusy) {
  world_.Tell("set Speak = PAUSE");
  world_.Tell("set Speak = RESUME");
  Prepare();
  world_.Tell("set Speak = NOW");
  world_.Pass(700);
  world_.Tell("set Speak = PAUSE");
  EXPECT_EQ(world_.errors, (Lines{"BUSY not speaking, there is nothing to pause",
                                  "BUSY not paused; set Speak = PAUSE comes first"}));
}

TEST_P(VoicePauseTest, TheNextTextIsReadyRightAfterTheEndOfThePresentOne) {
  Prepare();
  world_.Tell("set Speak = NOW");
  world_.Pass(500);
  world_.Tell("set#1 Text.next = Another text.");
  world_.Lines();
  world_.UntilIdle();
  const double idle = world_.When("rep Speak.stat = IDLE");
  EXPECT_GE(idle, 0);
  EXPECT_DOUBLE_EQ(world_.When("rep Speak.stat = READY"), idle);
  EXPECT_DOUBLE_EQ(world_.When("rep Text.text = Another text."), idle);
  EXPECT_EQ(world_.Ask("Text.text"), "Another text.");
  world_.Tell("set Speak = NOW");
  EXPECT_EQ(world_.Ask("Speak.stat"), "SPEAKING");
}

/// Counts what it is given to do.
class CountingWorker final : public ssm::Worker {
 public:
  explicit CountingWorker(int& jobs) : jobs_(jobs) {}
  void Run(std::function<void()> job, std::function<void()> done) override {
    ++jobs_;
    job();
    done();
  }
  bool immediate() const override { return true; }

 private:
  int& jobs_;
};

TEST(VoiceNextTest, ATextThatIsTheNextTextIsNotMadeAgain) {
  int jobs = 0;
  VoiceWorld world(ssm_stub::MakeRuleEngine(), std::make_unique<CountingWorker>(jobs));
  world.Tell("set Text = One text.");
  world.Tell("set Speak = NOW");
  world.Pass(500);
  world.Tell("set#1 Text.next = Another text.");
  world.UntilIdle();
  world.Lines();
  const int made = jobs;
  world.Tell("set#2 Text = Another text.");
  const Lines said = world.Lines();
  ASSERT_EQ(said.size(), 9u) << testing::PrintToString(said);
  EXPECT_EQ(said.front(), "rep Speak.stat = PROCESSING");
  EXPECT_EQ(said[1], "rep Text.text = Another text.");
  EXPECT_TRUE(said[3].starts_with("rep Text.pho = ")) << said[3];
  EXPECT_EQ(said[7], "rep Speak.stat = READY");
  EXPECT_EQ(said[8], "rep#2 Text = Another text.");
  EXPECT_EQ(jobs, made) << "what Text.next has made is taken";
  world.Tell("set Rate = 2");
  world.Tell("set Text = Another text.");
  EXPECT_GT(jobs, made) << "another manner needs another plan";
}

TEST_P(VoicePauseTest, ATextThatComesWhileAnotherIsSpokenIsSpokenAfterIt) {
  Prepare();
  world_.Tell("set Speak = NOW");
  world_.Pass(500);
  world_.Tell("set#1 Text = Another text.");
  world_.Tell("set#2 Speak = NOW");
  world_.Tell("set#3 Speak = NOW");
  const support::TempDir folder;
  world_.Tell("set#4 SaveWAV = " + folder / "next.wav");
  EXPECT_EQ(world_.Ask("Text.text"), kText) << "the present text is still the present one";
  EXPECT_FALSE(std::filesystem::exists(folder / "next.wav"));
  world_.UntilIdle();
  EXPECT_EQ(world_.Ask("Text.text"), "Another text.");
  EXPECT_TRUE(std::filesystem::exists(folder / "next.wav")) << "of the text that came before it";
  const double idle = world_.When("rep Speak.stat = IDLE");
  EXPECT_DOUBLE_EQ(world_.When("rep Speak.stat = READY"), idle);
  EXPECT_DOUBLE_EQ(world_.When("rep Speak.text = Another text."), idle);
  EXPECT_EQ(world_.errors, Lines{"BUSY the next text is to be spoken already"});
}

TEST_P(VoicePauseTest, StopDropsTheNextTextToo) {
  Prepare();
  world_.Tell("set Speak = NOW");
  world_.Pass(500);
  world_.Tell("set Text.next = Another text.");
  world_.Tell("set Speak = STOP");
  world_.UntilIdle();
  EXPECT_EQ(world_.Ask("Text.text"), kText);
  EXPECT_EQ(world_.Ask("Speak.stat"), "IDLE");
}

TEST_P(VoicePauseTest, EmotionChangesTheSpeedWithItsStrength) {
  const long plain = Prepare();
  world_.Tell("set Emotion = SAD");
  const long sad = Prepare();
  world_.Tell("set Emotion = SAD 50");
  const long half = Prepare();
  EXPECT_GT(sad, plain * 11 / 10);
  EXPECT_GT(half, plain);
  EXPECT_LT(half, sad);
  world_.Tell("set Emotion = NEUTRAL");
  EXPECT_EQ(Prepare(), plain);
  world_.Tell("set Emotion = HUNGRY");
  world_.Tell("set Emotion = SAD 101");
  EXPECT_EQ(world_.errors.size(), 2u);
}

TEST_P(VoicePauseTest, BrokenSsmlIsAnErrorAndTheNextTextWorks) {
  world_.Tell("set#1 Text = <speak>a<break></speak>");
  const Lines said = world_.Lines();
  ASSERT_EQ(said.size(), 3u);
  EXPECT_EQ(said[1], "rep Speak.stat = ERROR");
  EXPECT_TRUE(said[2].starts_with("rep#1 Text.error = SYNTAX SSML:1:")) << said[2];
  Prepare("<speak>Hello <mark name='here'/> you</speak>");
  EXPECT_EQ(world_.Ask("Speak.stat"), "READY");
  EXPECT_EQ(world_.Ask("Speak.text"), "Hello you");
}

TEST_P(VoicePauseTest, SaveOfAWavFileHasItsLabelsBesideIt) {
  const support::TempDir folder;
  const std::string path = folder / "speech.wav";
  const long length = Prepare("Hello.");
  world_.Tell("set Save = " + path);
  std::ifstream labels(path + ".lab");
  long end = 0, next = 0, last = 0;
  for (std::string name; labels >> next >> end >> name; last = end) EXPECT_EQ(next, last);
  EXPECT_EQ(last, length * 10'000);
  std::ifstream wav(path, std::ios::binary);
  const std::string head{std::istreambuf_iterator<char>(wav), {}};
  EXPECT_EQ(head.substr(0, 4), "RIFF");
}

}  // namespace
}  // namespace ssm_test
