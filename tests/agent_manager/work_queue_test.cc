#include "agent_manager/routing/work_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace am {
namespace {

using std::chrono::milliseconds;
using Strings = std::vector<std::string>;

/// A queue whose items take as long as they say.
class WorkQueueTest : public testing::Test {
 protected:
  void Post(PeerKey cause, const std::string& name, milliseconds length = milliseconds(0)) {
    queue_.Post(
        [this, name, length] {
          done_.push_back(name);
          now_ += length;
        },
        cause);
  }
  void Say(PeerKey cause, const std::string& value) {
    queue_.PushCaused({.message = vm::Set("X", value), .origin = {.peer = cause}, .machine = "M"});
  }
  /// What one turn has dealt with.
  Strings Turn() {
    done_.clear();
    queue_.Drain([this](WorkQueue::Item& item) {
      if (const auto* const work = std::get_if<Work>(&item)) return work->act();
      done_.push_back(std::get<Envelope>(item).message.value);
    });
    return done_;
  }

  std::chrono::steady_clock::time_point now_{};
  Strings done_, lanes_;
  WorkQueue queue_{[this](PeerKey cause, bool begins) {
                     lanes_.push_back((begins ? "+" : "-") + std::to_string(cause));
                   },
                   [this] { return now_; }};
};

TEST_F(WorkQueueTest, WhatFitsIntoATurnIsDoneInTheOrderInWhichItCame) {
  for (const PeerKey cause : {3U, 1U, 2U, 1U, 3U}) Post(cause, std::to_string(cause));
  EXPECT_EQ(Turn(), (Strings{"3", "1", "2", "1", "3"}));
  EXPECT_TRUE(lanes_.empty());
  EXPECT_TRUE(queue_.empty());
}

TEST_F(WorkQueueTest, WhoCausesMuchDelaysOthersByATurnAndWaitsInALane) {
  for (int i = 0; i < 2000; ++i) Post(1, "much", milliseconds(1));
  Post(2, "short");
  std::size_t turns = 0, done = 0;
  for (bool found = false; !found; ++turns) {
    const Strings all = Turn();
    done += all.size();
    found = std::ranges::find(all, "short") != all.end();
    ASSERT_LT(turns, 3u);
  }
  EXPECT_LT(done, 10u);
  // One that has no lane goes ahead of those that have.
  Post(3, "new");
  EXPECT_EQ(Turn().front(), "new");
  EXPECT_EQ(lanes_, (Strings{"+1", "+2", "-2"}));
}

TEST_F(WorkQueueTest, ALaneKeepsTheOrderAlsoOfWhatComesLater) {
  for (int i = 0; i < 40; ++i) Post(1, std::to_string(i), milliseconds(1));
  Strings all = Turn();
  for (int i = 40; i < 60; ++i) Post(1, std::to_string(i));
  while (!queue_.empty()) {
    for (const std::string& name : Turn()) all.push_back(name);
  }
  Strings expected;
  for (int i = 0; i < 60; ++i) expected.push_back(std::to_string(i));
  EXPECT_EQ(all, expected);
  EXPECT_EQ(lanes_, (Strings{"+1", "-1"}));
}

TEST_F(WorkQueueTest, LanesTakeTurnsAndTheHubWaitsForNoLane) {
  for (int i = 0; i < 8; ++i) Post(1, "a", milliseconds(1));
  for (int i = 0; i < 4; ++i) Post(2, "b", milliseconds(1));
  Turn();
  Post(kHub, "hub");
  EXPECT_EQ(Turn(), (Strings{"hub", "b", "a"}));
  EXPECT_EQ(Turn(), (Strings{"b", "a"}));
}

TEST_F(WorkQueueTest, OnTheVirtualClockATurnHasNoEnd) {
  queue_.set_lockstep(true);
  for (unsigned i = 0; i < 100; ++i) Post(1 + i % 2, "x", milliseconds(5));
  EXPECT_EQ(Turn().size(), 100u);
}

TEST_F(WorkQueueTest, WhatIsCausedIsCountedUntilItIsTaken) {
  for (int i = 0; i < 3; ++i) Say(1, std::string(100, 'x'));
  EXPECT_EQ(queue_.CausedBy(1).items, 3u);
  EXPECT_GE(queue_.CausedBy(1).bytes, 300u);
  EXPECT_EQ(queue_.CausedBy(2).items, 0u);
  Turn();
  EXPECT_EQ(queue_.CausedBy(1).items, 0u);
  EXPECT_EQ(queue_.CausedBy(1).bytes, 0u);
}

}  // namespace
}  // namespace am
