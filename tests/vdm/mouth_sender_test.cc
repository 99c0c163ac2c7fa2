// Which frames a face is told, and how their time is counted.

#include "vdm/core/mouth_sender.h"

#include <gtest/gtest.h>

namespace vdm {
namespace {

using namespace std::chrono_literals;

class MouthSenderTest : public testing::Test {
 protected:
  void Feed(vm::Time from, vm::Time to, bool open) {
    MouthFrame frame;
    frame.seal = open ? 0 : 1;
    frame.mouth[11] = open ? 5 : 0;
    for (vm::Time at = from; at < to; at += 10ms) sender_.Add(at, frame);
  }
  struct Told {
    vm::Time at;
    float seal;
  };
  std::vector<vm::Time> starts_;
  std::vector<Told> told_;
  std::vector<bool> moving_;
  MouthSender sender_{
      {.start = [this](vm::Time at) { starts_.push_back(at); },
       .frame =
           [this](double ms, const MouthFrame& frame, const std::optional<HeadPose>&) {
             told_.push_back({starts_.back() + vm::Time(static_cast<long>(ms * 1000)), frame.seal});
           },
       .moving = [this](bool moving) { moving_.push_back(moving); }}};
};

TEST_F(MouthSenderTest, AMouthAtRestIsNotSpokenOf) {
  Feed(0ms, 5s, false);
  EXPECT_TRUE(told_.empty());
  EXPECT_FALSE(sender_.moving());
}

TEST_F(MouthSenderTest, ARunGoesFromTheLastRestToTheNext) {
  Feed(0ms, 1s, false);
  Feed(1s, 2s, true);
  Feed(2s, 4s, false);
  EXPECT_EQ(starts_, std::vector{vm::Time(990ms)});
  EXPECT_EQ(moving_, (std::vector{true, false}));
  EXPECT_EQ(told_.front().at, 990ms);
  EXPECT_EQ(told_.front().seal, 1);
  EXPECT_EQ(told_.back().seal, 1);
  EXPECT_GE(told_.back().at, 2290ms);
  EXPECT_LE(told_.back().at, 2340ms);
  for (std::size_t i = 1; i < told_.size(); ++i)
    EXPECT_EQ(told_[i].at - told_[i - 1].at, 20ms) << i;
}

TEST_F(MouthSenderTest, ShortClosuresAreWithinARun) {
  Feed(0ms, 500ms, true);
  Feed(500ms, 600ms, false);
  Feed(600ms, 1s, true);
  EXPECT_EQ(starts_.size(), 1U);
  EXPECT_EQ(std::ranges::count(told_, 1.0F, &Told::seal), 5);
}

TEST_F(MouthSenderTest, WhereTimeGoesBackANewStartReplacesWhatWasToCome) {
  Feed(1s, 2s, true);
  Feed(1500ms, 2s, true);
  EXPECT_EQ(starts_, (std::vector{vm::Time(1s), vm::Time(1500ms)}));
  EXPECT_EQ(moving_, std::vector{true});
  EXPECT_EQ(told_.back().at, 1980ms);
  EXPECT_EQ(told_.size(), 75U);
}

TEST_F(MouthSenderTest, ALongRunIsGivenNewStarts) {
  Feed(0ms, 25s, true);
  EXPECT_EQ(starts_.size(), 3U);
  EXPECT_EQ(moving_, std::vector{true});
}

TEST_F(MouthSenderTest, TheEndOfTheSoundClosesTheMouth) {
  Feed(0ms, 500ms, true);
  sender_.Finish();
  EXPECT_EQ(told_.back().seal, 1);
  EXPECT_FALSE(sender_.moving());
  sender_.Finish();
  EXPECT_EQ(moving_, (std::vector{true, false}));
}

TEST(FrameTextTest, NumbersAreShort) {
  MouthFrame frame;
  frame.mouth[0] = -0.001F;
  frame.mouth[1] = 1.25F;
  frame.mouth[16] = -3;
  frame.seal = 0.5F;
  EXPECT_EQ(FrameText(12340, frame), "12340 0 1.25 0 0 0 0 0 0 0 0 0 0 0 0 0 0 -3 0.5 0");
  EXPECT_EQ(FrameText(12340, frame, HeadPose{{1.5F, -0.001F, 2}, 0.25F}),
            "12340 0 1.25 0 0 0 0 0 0 0 0 0 0 0 0 0 0 -3 0.5 0 1.5 0 2 0.25");
}

}  // namespace
}  // namespace vdm
