#include "vm_protocol/core/clock_estimate.h"

#include <gtest/gtest.h>

#include <random>

namespace vm {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

TEST(ClockEstimateTest, OneExchangeSplitsTheDelay) {
  ClockEstimate estimate;
  EXPECT_FALSE(estimate.known());
  estimate.Add(milliseconds(100), milliseconds(120), milliseconds(5110));
  EXPECT_EQ(estimate.offset(), milliseconds(5000));
  EXPECT_EQ(estimate.delay(), milliseconds(20));
  EXPECT_EQ(estimate.uncertainty(), milliseconds(10));
}

TEST(ClockEstimateTest, TheQuickestExchangeCountsUntilItIsTooOld) {
  ClockEstimate estimate;
  estimate.Add(seconds(0), milliseconds(2), milliseconds(1001));
  estimate.Add(seconds(1), seconds(1) + milliseconds(40), seconds(2));
  EXPECT_EQ(estimate.offset(), milliseconds(1000));
  // 100 ppm of 200 s are 20 ms: by then an exchange of 30 ms leaves open less.
  estimate.Add(seconds(200), seconds(200) + milliseconds(30), seconds(201) + milliseconds(15));
  EXPECT_EQ(estimate.offset(), milliseconds(1000));
  EXPECT_EQ(estimate.delay(), milliseconds(30));
}

TEST(ClockEstimateTest, AClockThatHasJumpedIsFollowedAtOnce) {
  ClockEstimate estimate;
  estimate.Add(seconds(0), milliseconds(2), seconds(100));  // a quick exchange
  estimate.Add(seconds(2), seconds(2) + milliseconds(40), seconds(702) + milliseconds(20));
  EXPECT_EQ(estimate.offset(), seconds(700)) << "however slow the exchange that tells of it";
  EXPECT_EQ(estimate.delay(), milliseconds(40));
}

TEST(ClockEstimateTest, AnExchangeThatIsOnlySlowDoesNotMoveIt) {
  ClockEstimate estimate;
  estimate.Add(seconds(0), milliseconds(2), seconds(100) + milliseconds(1));
  estimate.Add(seconds(2), seconds(2) + milliseconds(200), seconds(102) + milliseconds(190));
  EXPECT_EQ(estimate.offset(), seconds(100));
}

/// A link with delay and jitter, and a clock that runs fast; asked every two seconds, twice.
struct Link {
  milliseconds delay, jitter;
  double skew;
};
class ClockEstimateLinkTest : public testing::TestWithParam<Link> {};

TEST_P(ClockEstimateLinkTest, StaysWithinWhatItSaysAndWithinTheJitter) {
  const Link link = GetParam();
  std::mt19937 random(7);
  std::uniform_int_distribution<long> jitter(0, link.jitter.count() * 1000);
  ClockEstimate estimate;
  const auto theirs = [&](vm::Time ours) {
    return ours + milliseconds(123456) +
           vm::Time(static_cast<vm::Time::rep>(static_cast<double>(ours.count()) * link.skew));
  };
  microseconds worst{0};
  for (int i = 0; i < 3600; ++i) {
    const vm::Time asked = seconds(2 * (i / 2));
    const vm::Time arrives = asked + link.delay + microseconds(jitter(random));
    const vm::Time heard = arrives + link.delay + microseconds(jitter(random));
    estimate.Add(asked, heard, theirs(arrives));
    const microseconds error = std::chrono::abs(estimate.offset() - (theirs(heard) - heard));
    ASSERT_LE(error, estimate.uncertainty() + microseconds(1000));
    if (i > 20) worst = std::max(worst, error);
  }
  EXPECT_LE(worst, link.jitter / 2 + milliseconds(1));
}

INSTANTIATE_TEST_SUITE_P(Links, ClockEstimateLinkTest,
                         testing::Values(Link{milliseconds(0), milliseconds(0), 0},
                                         Link{milliseconds(40), milliseconds(0), 50e-6},
                                         Link{milliseconds(20), milliseconds(10), 80e-6},
                                         Link{milliseconds(150), milliseconds(60), -80e-6}));

}  // namespace
}  // namespace vm
