#include "vm_protocol/core/scheduler.h"

#include <gtest/gtest.h>

#include <string>

#include "vm_protocol/core/timer.h"

namespace vm {
namespace {

using std::chrono::milliseconds;

TEST(VirtualSchedulerTest, RunsTimersInOrderOfTimeThenOfSetting) {
  VirtualScheduler clock;
  std::string order;
  clock.At(milliseconds(2), [&] { order += 'c'; });
  clock.At(milliseconds(1), [&] { order += 'a'; });
  clock.At(milliseconds(1), [&] { order += 'b'; });
  EXPECT_TRUE(clock.RunUntilIdle(milliseconds(10)));
  EXPECT_EQ(order, "abc");
  EXPECT_EQ(clock.Now(), milliseconds(2));
}

TEST(VirtualSchedulerTest, ACallbackSeesItsOwnInstantAndMaySetMore) {
  VirtualScheduler clock;
  std::vector<Time> seen;
  std::function<void()> tick = [&] {
    seen.push_back(clock.Now());
    if (seen.size() < 3) clock.After(milliseconds(5), tick);
  };
  clock.After(milliseconds(5), tick);
  clock.RunUntil(milliseconds(12));
  EXPECT_EQ(seen, (std::vector<Time>{milliseconds(5), milliseconds(10)}));
  EXPECT_EQ(clock.Now(), milliseconds(12));
  EXPECT_EQ(clock.Next(), Time(milliseconds(15)));
}

TEST(VirtualSchedulerTest, ACancelledTimerNeverRuns) {
  VirtualScheduler clock;
  bool ran = false;
  const TimerId second = clock.At(milliseconds(1), [&] { ran = true; });
  clock.At(Time(0), [&] { clock.Cancel(second); });
  clock.RunUntilIdle(milliseconds(10));
  EXPECT_FALSE(ran);
  clock.Cancel(second);
  clock.Cancel(12345);
}

TEST(VirtualSchedulerTest, StopsAtItsLimit) {
  VirtualScheduler clock;
  std::function<void()> forever = [&] { clock.After(milliseconds(1), forever); };
  forever();
  EXPECT_FALSE(clock.RunUntilIdle(milliseconds(100)));
  EXPECT_EQ(clock.Now(), milliseconds(100));
}

TEST(TimerTest, HasOneActionPendingAtMostAndCancelsItAtItsEnd) {
  VirtualScheduler clock;
  std::string order;
  {
    Timer timer(clock);
    timer.At(milliseconds(10), [&] { order += 'a'; });
    timer.At(milliseconds(20), [&] {
      order += timer.pending() ? 'x' : 'b';
      timer.At(milliseconds(30), [&] { order += 'c'; });
    });
    EXPECT_EQ(clock.pending(), 1U);
    clock.RunUntil(milliseconds(40));
    EXPECT_EQ(order, "bc");
    timer.At(milliseconds(50), [&] { order += 'd'; });
    timer.Cancel();
    EXPECT_FALSE(timer.pending());
    timer.At(milliseconds(50), [&] { order += 'e'; });
  }
  EXPECT_EQ(clock.pending(), 0U);
}

TEST(TimeTextTest, MillisecondsAreWrittenShortAndReadBackExactly) {
  EXPECT_EQ(FormatMs(Time(0)), "0");
  EXPECT_EQ(FormatMs(Time(1234500)), "1234.5");
  EXPECT_EQ(FormatMs(Time(-1050)), "-1.05");
  EXPECT_EQ(FormatMs(Time(7)), "0.007");
  for (const Time::rep us : {0L, 1L, 999L, 1000L, 123456789L, -42L}) {
    EXPECT_EQ(ParseMs(FormatMs(Time(us))), Time(us));
  }
  for (const auto* bad : {"", "x", "1x", "nan", "inf", "0x10", "1e13", " 1"}) {
    EXPECT_FALSE(ParseMs(bad)) << bad;
  }
}

}  // namespace
}  // namespace vm
