// What happens while a long text is prepared or its sound is still made: a worker that works only
// when told to stands for the thread.

#include <gtest/gtest.h>

#include <deque>

#include "ssm/voice/wav_file.h"
#include "ssm_stub/rule_engine.h"
#include "tests/ssm/voice_world.h"
#include "tests/support/process.h"

namespace ssm_test {
namespace {

using Lines = std::vector<std::string>;

class HeldWorker final : public ssm::Worker {
 public:
  using Queue = std::deque<std::function<void()>>;
  explicit HeldWorker(Queue& queue) : queue_(queue) {}
  void Run(std::function<void()> job, std::function<void()> done) override {
    queue_.push_back([job = std::move(job), done = std::move(done)] {
      job();
      done();
    });
  }
  bool immediate() const override { return false; }

 private:
  Queue& queue_;
};

class WaitingTest : public testing::Test {
 protected:
  HeldWorker::Queue jobs_;
  VoiceWorld world_{ssm_stub::MakeRuleEngine(), std::make_unique<HeldWorker>(jobs_)};
  const std::string long_ = "This is a long text. " + std::string(300, 'm') + ".";

  void Work() {
    ASSERT_FALSE(jobs_.empty());
    auto job = std::move(jobs_.front());
    jobs_.pop_front();
    job();
  }
  bool Said(const std::string& line) { return world_.When(line) >= 0; }
};

TEST_F(WaitingTest, AShortTextIsReadyAtOnceThoughItsSoundIsNot) {
  world_.Tell("set Text = Hello.");
  EXPECT_EQ(world_.Ask("Speak.stat"), "READY");
  EXPECT_EQ(jobs_.size(), 1u);
  world_.Tell("set Speak = NOW");
  EXPECT_EQ(world_.Ask("Speak.stat"), "SPEAKING");
}

TEST_F(WaitingTest, ALongTextIsProcessingUntilItsPhonemesAreKnown) {
  world_.Tell("set#1 Text = " + long_);
  EXPECT_EQ(world_.Lines(), (Lines{"rep Speak.stat = PROCESSING", "rep Text.text = " + long_,
                                   "rep Speak.text = " + long_}));
  EXPECT_TRUE(world_.module->Busy());
  Work();
  const Lines lines = world_.Lines();
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[4], "rep Speak.stat = READY");
  EXPECT_EQ(lines[5], "rep#1 Text = " + long_);
}

TEST_F(WaitingTest, SpeakWhileProcessingStartsAsSoonAsItCan) {
  world_.Tell("set Text = " + long_);
  world_.Tell("set#1 Speak = +100");
  world_.Pass(40);
  EXPECT_EQ(world_.Ask("Speak.stat"), "PROCESSING");
  Work();
  EXPECT_TRUE(Said("rep#1 Speak = +100"));
  world_.UntilIdle();
  EXPECT_EQ(world_.When("rep Speak.stat = SPEAKING"), 100) << "the delay counts from the request";
}

TEST_F(WaitingTest, StopWhileProcessingEndsEverythingThatWaits) {
  world_.Tell("set#1 Text = " + long_);
  world_.Tell("set#2 Speak = NOW");
  world_.Lines();
  world_.Tell("set#3 Speak = STOP");
  const Lines lines = world_.Lines();
  EXPECT_TRUE(lines.at(0).starts_with("rep#2 Speak.error = STOPPED"));
  EXPECT_EQ(Lines(lines.begin() + 1, lines.end()),
            (Lines{"rep#1 Text.error = STOPPED set Speak = STOP came first", "rep Speak.len = 0",
                   "rep Speak.utt = ", "rep Speak.stat = IDLE", "rep#3 Speak = STOP"}));
  Work();  // the worker comes too late
  EXPECT_EQ(world_.Lines(), Lines{});
  EXPECT_FALSE(world_.module->Busy());
  world_.Tell("set Text = Next.");
  EXPECT_EQ(world_.Ask("Speak.stat"), "READY");
}

TEST_F(WaitingTest, SavesAndTextsInARowAllHappenInOrder) {
  const support::TempDir dir;
  world_.Tell("set Text = One.");
  world_.Tell("set SaveWAV = " + dir / "1.wav");
  world_.Tell("set Text = " + long_);
  world_.Tell("set SaveWAV = " + dir / "2.wav");
  world_.Tell("set Text = Three times three.");
  world_.Tell("set SaveWAV = " + dir / "3.wav");
  world_.Tell("set Speak = NOW");
  while (!jobs_.empty()) Work();
  EXPECT_EQ(world_.errors, Lines{});
  EXPECT_EQ(world_.Ask("Speak.stat"), "SPEAKING");
  for (const char* name : {"1.wav", "2.wav", "3.wav"}) {
    EXPECT_TRUE(ssm::ReadWav(dir / name)) << name;
  }
  const auto third = ssm::ReadWav(dir / "3.wav");
  EXPECT_EQ(third->size(), std::stoul(world_.Ask("Text.dur")) * 16);
}

TEST_F(WaitingTest, TooManyWaitingRequestsAreRefused) {
  world_.Tell("set Text = " + long_);
  for (std::size_t i = 0; i < ssm::kMaxWaiting; ++i) world_.Tell("set Text = x");
  world_.Lines();
  world_.Tell("set#9 Text = y");
  EXPECT_TRUE(world_.Lines().at(0).starts_with("rep#9 Text.error = LIMIT "));
  while (!jobs_.empty()) Work();
  EXPECT_FALSE(world_.module->Busy());
}

TEST_F(WaitingTest, TheModuleMayEndInTheMiddleOfWork) {
  world_.Tell("set Text = " + long_);
  auto job = std::move(jobs_.front());
  jobs_.clear();
  world_.module->Shutdown();
}

// An engine that fails, as engines do.
class BrokenEngine final : public ssm::SpeechEngine {
 public:
  BrokenEngine(bool plan_fails) : plan_fails_(plan_fails) {}
  const std::vector<ssm::VoiceInfo>& voices() const override { return voices_; }
  vm::Result<ssm::SpeechPlan> Plan(const std::vector<ssm::SpeechSpan>&,
                                   const std::atomic<bool>&) override {
    if (plan_fails_) return vm::Fail(vm::Errc::kUnavailable, "out of order");
    ssm::SpeechPlan plan;
    plan.phonemes = {{"a", ssm::Millis(500)}};
    return plan;
  }
  vm::Result<void> Render(const ssm::SpeechPlan&, ssm::SampleBuffer&) override {
    return vm::Fail(vm::Errc::kUnavailable, "no sound");
  }

 private:
  const bool plan_fails_;
  std::vector<ssm::VoiceInfo> voices_ = {{.name = "x", .language = "en"}};
};

TEST(BrokenEngineTest, AFailureIsAnErrorStateAndAnAnswer) {
  for (const bool plan_fails : {true, false}) {
    VoiceWorld world(std::make_unique<BrokenEngine>(plan_fails));
    world.Tell("set#1 Text = Hello.");
    const Lines lines = world.Lines();
    ASSERT_GE(lines.size(), 2u);
    EXPECT_EQ(lines[lines.size() - 2], "rep Speak.stat = ERROR");
    EXPECT_TRUE(lines.back().starts_with("rep#1 Text.error = UNAVAILABLE "));
    EXPECT_EQ(world.errors.size(), 1u);
    world.Tell("set#2 Speak = NOW");
    EXPECT_TRUE(world.Lines().back().starts_with("rep#2 Speak.error = BUSY "));
    world.Tell("set Speak = STOP");
    EXPECT_EQ(world.Lines(), Lines{"rep Speak.stat = IDLE"});
  }
}

TEST(BrokenEngineTest, SoundThatFailsWhileSpeakingEndsWithATail) {
  HeldWorker::Queue jobs;
  VoiceWorld world(std::make_unique<BrokenEngine>(false), std::make_unique<HeldWorker>(jobs));
  world.Tell("set Text = Hello.");
  world.Tell("set Speak = NOW");
  world.Pass(100);
  world.Lines();
  jobs.front()();
  EXPECT_EQ(world.Lines(), (Lines{"rep Speak.stat = ERROR", "rep Speak.len = 100",
                                  "rep Speak.utt = a[100]", "rep Speak.stat = IDLE"}));
  EXPECT_FALSE(world.module->Busy());
}

}  // namespace
}  // namespace ssm_test
