#include <gtest/gtest.h>

#include <chrono>
#include <vector>

#include "fsm/app/frame_loop.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;
using Times = std::vector<vm::Time>;

/// A loop on a virtual clock, whose subject moves from `moves_from` until `rests_at`.
class FrameLoopTest : public testing::Test {
 protected:
  vm::VirtualScheduler clock_;
  std::optional<FrameLoop::Wanted> wanted_ = FrameLoop::Wanted{10};
  vm::Time moves_from_ = 0ms, rests_at_ = 0ms;
  bool fails_ = false;
  Times shown_;
  FrameLoop loop_{clock_,
                  {.wanted = [this] { return wanted_; },
                   .next_motion = [this](vm::Time t) -> std::optional<vm::Time> {
                     if (t >= rests_at_) return std::nullopt;
                     return std::max(t, moves_from_);
                   },
                   .rests_at = [this](vm::Time t) { return std::max(t, rests_at_); },
                   .show =
                       [this](vm::Time t) {
                         shown_.push_back(t);
                         return !fails_;
                       }}};
};

TEST_F(FrameLoopTest, AChangeIsShownOnceInTheNextFrameOfTheGrid) {
  clock_.RunUntil(130ms);
  loop_.OnChange();
  loop_.OnChange();
  clock_.RunUntil(5s);
  EXPECT_EQ(shown_, (Times{200ms}));
  EXPECT_EQ(clock_.pending(), 0U) << "nothing is waited for at rest";
}

TEST_F(FrameLoopTest, MotionIsShownInEachFrameUntilItRests) {
  moves_from_ = 250ms;
  rests_at_ = 450ms;
  loop_.OnChange();
  EXPECT_FALSE(loop_.AtRest());
  clock_.RunUntil(5s);
  EXPECT_EQ(shown_, (Times{100ms, 300ms, 400ms, 500ms}));
  EXPECT_TRUE(loop_.AtRest());
}

TEST_F(FrameLoopTest, AWindowIsShownNowAndThenAtRest) {
  wanted_->in_window = true;
  loop_.OnChange();
  clock_.RunUntil(600ms);
  EXPECT_EQ(shown_, (Times{100ms, 300ms, 500ms}));
}

TEST_F(FrameLoopTest, ChangesDoNotPutOffAFrameThatIsDue) {
  wanted_ = FrameLoop::Wanted{1, true};
  loop_.OnChange();
  clock_.RunUntil(1100ms);  // the window's events are due at 1200 ms
  loop_.OnChange();
  clock_.RunUntil(1200ms);
  EXPECT_EQ(shown_, (Times{1000ms, 1200ms}));
}

TEST_F(FrameLoopTest, WithoutFramesTheEndOfMotionIsStillWaitedFor) {
  wanted_.reset();
  rests_at_ = 450ms;
  loop_.OnChange();
  EXPECT_EQ(clock_.Next(), vm::Time(450ms));
  rests_at_ = 700ms;  // without a change, as where settings move it
  EXPECT_TRUE(clock_.RunUntilIdle(5s));
  EXPECT_EQ(clock_.Now(), vm::Time(700ms));
  EXPECT_TRUE(shown_.empty());
}

TEST_F(FrameLoopTest, NoFrameFollowsAFailureOrStop) {
  rests_at_ = 1s;
  fails_ = true;
  loop_.OnChange();
  clock_.RunUntil(2s);
  EXPECT_EQ(shown_, (Times{100ms}));
  loop_.OnChange();
  loop_.Stop();
  clock_.RunUntil(3s);
  EXPECT_EQ(shown_.size(), 1U);
}

}  // namespace
}  // namespace fsm
