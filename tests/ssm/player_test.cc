#include "ssm/voice/player.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ssm {
namespace {

/// A device that starts late and runs slow, as real ones do.
class LazySink final : public AudioSink {
 public:
  explicit LazySink(vm::Scheduler& scheduler) : scheduler_(scheduler) {}
  vm::Result<void> Play(std::shared_ptr<const SampleBuffer> samples, vm::Time start) override {
    if (refuse) return vm::Fail(vm::Errc::kUnavailable, "no device");
    samples_ = std::move(samples);
    first_ = start + late;
    return {};
  }
  Position Where() const override {
    const double ran = static_cast<double>((scheduler_.Now() - first_).count()) * speed;
    const auto frames = FramesIn(vm::Time(std::llround(ran)));
    return {std::min(frames, samples_->size()), first_, broken};
  }
  Position Stop() override { return Where(); }
  std::string name() const override { return "lazy"; }

  vm::Time late{0};
  double speed = 1;
  bool refuse = false;
  bool broken = false;

 private:
  vm::Scheduler& scheduler_;
  std::shared_ptr<const SampleBuffer> samples_;
  vm::Time first_{0};
};

class PlayerTest : public testing::Test {
 protected:
  vm::VirtualScheduler clock_;
  LazySink sink_{clock_};
  std::vector<std::string> told_;
  Player player_{
      clock_,
      sink_,
      {.started = [this] { Note("start"); },
       .sync = [this](std::size_t frames) { Note("sync " + std::to_string(frames / 16)); },
       .ended =
           [this](AudioSink::Position end, bool failed) {
             Note((failed ? "failed " : "end ") + std::to_string(end.frames / 16));
           }}};
  void Note(const std::string& what) {
    told_.push_back(std::to_string(clock_.Now().count() / 1000) + " " + what);
  }
  std::shared_ptr<SampleBuffer> Sound(int ms) {
    auto samples = std::make_shared<SampleBuffer>(ToFrames(std::chrono::milliseconds(ms)));
    samples->Finish();
    return samples;
  }
};

TEST_F(PlayerTest, CuesAndTicksComeWhenTheirFramesAreHeard) {
  player_.set_sync_interval(16 * 400);
  ASSERT_TRUE(player_.Start(Sound(1000), vm::Time(50'000),
                            {{0, [this] { Note("first"); }}, {16 * 333, [this] { Note("cue"); }}}));
  clock_.RunUntilIdle(vm::Time(10'000'000));
  EXPECT_EQ(told_, (std::vector<std::string>{"50 start", "50 first", "383 cue", "450 sync 400",
                                             "850 sync 800", "1050 end 1000"}));
}

TEST_F(PlayerTest, ALateDeviceMakesEverythingLateButNothingWrong) {
  sink_.late = vm::Time(30'000);
  player_.set_sync_interval(16 * 500);
  ASSERT_TRUE(player_.Start(Sound(800), vm::Time(0), {}));
  clock_.RunUntilIdle(vm::Time(10'000'000));
  EXPECT_EQ(told_, (std::vector<std::string>{"0 start", "530 sync 500", "830 end 800"}));
}

TEST_F(PlayerTest, ASlowDeviceIsAskedAgainAndItsOwnPositionIsTold) {
  sink_.speed = 0.9;
  player_.set_sync_interval(16 * 500);
  ASSERT_TRUE(player_.Start(Sound(900), vm::Time(0), {}));
  clock_.RunUntilIdle(vm::Time(10'000'000));
  ASSERT_EQ(told_.size(), 3u);
  EXPECT_EQ(told_[1], "556 sync 500");  // 500 / 0.9 = 555.6
  EXPECT_EQ(told_[2], "1000 end 900");
}

TEST_F(PlayerTest, ABrokenDeviceEndsTheUtterance) {
  player_.set_sync_interval(16 * 100);
  ASSERT_TRUE(player_.Start(Sound(900), vm::Time(0), {}));
  clock_.RunUntil(vm::Time(150'000));
  sink_.broken = true;
  clock_.RunUntil(vm::Time(400'000));
  EXPECT_EQ(told_.back(), "200 failed 200");
  EXPECT_FALSE(player_.active());
  EXPECT_EQ(clock_.pending(), 0u);
}

TEST_F(PlayerTest, ADeviceThatRefusesLeavesThePlayerIdle) {
  sink_.refuse = true;
  EXPECT_FALSE(player_.Start(Sound(900), vm::Time(0), {}));
  EXPECT_FALSE(player_.active());
  EXPECT_EQ(clock_.pending(), 0u);
}

TEST_F(PlayerTest, StopLeavesNoTimerBehind) {
  ASSERT_TRUE(player_.Start(Sound(900), vm::Time(100'000), {}));
  player_.Stop();
  EXPECT_EQ(clock_.pending(), 0u);
  ASSERT_TRUE(player_.Start(Sound(900), vm::Time(0), {}));
  clock_.RunUntil(vm::Time(150'000));
  EXPECT_EQ(player_.Stop().frames, 150u * 16);
  EXPECT_EQ(clock_.pending(), 0u);
  clock_.RunUntil(vm::Time(3'000'000));
  EXPECT_EQ(told_, std::vector<std::string>{"0 start"});
}

}  // namespace
}  // namespace ssm
