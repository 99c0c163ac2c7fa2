#include "agent_manager/supervision/restart_history.h"

#include <gtest/gtest.h>

namespace am {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

const RestartHistory::Time kStart{};

TEST(RestartPolicyTest, WaitsTwiceAsLongEachTimeUpToTheCap) {
  const RestartPolicy policy{.when = Restart::kAlways,
                             .first = milliseconds(200),
                             .longest = milliseconds(1000),
                             .tries = 8,
                             .within = seconds(60)};
  RestartHistory history;
  std::vector<long> delays;
  for (int i = 0; i < 5; ++i) {
    history.Started(kStart + seconds(i));
    delays.push_back(history.NextDelay(policy, true, kStart + seconds(i))->count());
  }
  EXPECT_EQ(delays, (std::vector<long>{200, 400, 800, 1000, 1000}));
}

TEST(RestartPolicyTest, TooManyStartsWithinTheTimeEndTheTrying) {
  const RestartPolicy policy{.tries = 3, .within = seconds(10)};
  RestartHistory history;
  for (int i = 0; i < 3; ++i) {
    history.Started(kStart + seconds(i));
    EXPECT_TRUE(history.NextDelay(policy, true, kStart + seconds(i))) << i;
  }
  history.Started(kStart + seconds(3));
  EXPECT_FALSE(history.NextDelay(policy, true, kStart + seconds(3)));
  EXPECT_TRUE(history.gave_up());
  history.Forgive();
  history.Started(kStart + seconds(4));
  EXPECT_TRUE(history.NextDelay(policy, true, kStart + seconds(4)));
  EXPECT_FALSE(history.gave_up());
}

TEST(RestartPolicyTest, StartsLongAgoDoNotCountAndTheWaitBeginsAnew) {
  const RestartPolicy policy{.tries = 2, .within = seconds(10)};
  RestartHistory history;
  for (int i = 0; i < 100; ++i) {
    history.Started(kStart + seconds(11 * i));
    EXPECT_EQ(history.NextDelay(policy, true, kStart + seconds(11 * i)), policy.first);
  }
}

TEST(RestartPolicyTest, OnFailureLeavesAnOrderlyEndAlone) {
  RestartHistory history;
  history.Started(kStart);
  EXPECT_FALSE(history.NextDelay({.when = Restart::kOnFailure}, false, kStart));
  EXPECT_TRUE(history.NextDelay({.when = Restart::kOnFailure}, true, kStart));
  EXPECT_TRUE(history.NextDelay({.when = Restart::kAlways}, false, kStart));
  EXPECT_FALSE(history.NextDelay({.when = Restart::kNever}, true, kStart));
  EXPECT_FALSE(history.gave_up());
}

}  // namespace
}  // namespace am
