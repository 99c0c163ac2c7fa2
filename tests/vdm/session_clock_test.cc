// Where the hub's clock stands.

#include "vdm/core/session_clock.h"

#include <gtest/gtest.h>

namespace vdm {
namespace {

using namespace std::chrono_literals;

class SessionClockTest : public testing::Test {
 protected:
  SessionClockTest() {
    slots_.set_output([this](vm::PeerId, const vm::Message& message) { said_.push_back(message); });
  }
  vm::VirtualScheduler clock_;
  vm::SlotMachine slots_{"VDM"};
  std::vector<vm::Message> said_;
  bool shared_ = false;
  SessionClock session_{clock_, slots_, [this] { return shared_; }};
};

TEST_F(SessionClockTest, ASharedClockIsNotAskedFor) {
  shared_ = true;
  session_.Start();
  EXPECT_TRUE(said_.empty());
  EXPECT_EQ(clock_.pending(), 0U);
  EXPECT_EQ(session_.StartText(1500ms), "@1500");
}

TEST_F(SessionClockTest, WithoutAHubTimesCountFromNow) {
  session_.Start();
  clock_.RunUntil(200ms);
  EXPECT_EQ(session_.StartText(350ms), "+150");
  EXPECT_EQ(session_.StartText(100ms), "+0");
}

TEST_F(SessionClockTest, AnswersTellTheOffset) {
  session_.Start();
  ASSERT_EQ(said_.size(), 1U);
  EXPECT_EQ(said_[0].to, std::vector<std::string>{"AM"});
  EXPECT_EQ(said_[0].slot, "Clock");
  clock_.RunUntil(4ms);
  vm::Message answer = vm::Rep("Clock", "10002");
  answer.tag = "somebody-elses";
  session_.Hear(answer);
  EXPECT_EQ(session_.StartText(100ms), "+96");
  answer.tag = said_[0].tag;
  session_.Hear(answer);  // asked at 0, heard at 4: it was 10002 at 2
  EXPECT_EQ(session_.StartText(100ms), "@10100");
  session_.Stop();
  EXPECT_EQ(clock_.pending(), 0U);
}

TEST_F(SessionClockTest, ItAsksOnWhileItRuns) {
  session_.Start();
  clock_.RunUntil(10s);
  EXPECT_GE(said_.size(), 8U);
  EXPECT_LE(said_.size(), 11U);
}

}  // namespace
}  // namespace vdm
