#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "vm_protocol/runtime/asio_scheduler.h"

namespace vm {
namespace {

using std::chrono::milliseconds;

TEST(ClockSchedulerTest, OnTheVirtualClockTimeMovesOnlyWhenTold) {
  boost::asio::io_context io;
  ClockScheduler clock(io, false);
  std::string order;
  clock.At(milliseconds(10), [&] { order += 'a'; });
  clock.At(milliseconds(20), [&] { order += 'b'; });
  io.poll();
  EXPECT_EQ(order, "");
  EXPECT_TRUE(clock.AdvanceToNext());
  EXPECT_EQ(order, "a");
  EXPECT_EQ(clock.Now(), milliseconds(10));
  clock.Advance(milliseconds(50));
  EXPECT_EQ(order, "ab");
  EXPECT_FALSE(clock.AdvanceToNext());
}

TEST(ClockSchedulerTest, OnTheRealClockTimersRunInOrderFromTheContext) {
  boost::asio::io_context io;
  ClockScheduler clock(io, true);
  std::string order;
  const Time start = clock.Now();  // once: under load much time may pass between two lines
  clock.At(start + milliseconds(3), [&] { order += 'b'; });
  clock.At(start + milliseconds(1), [&] {
    order += 'a';
    clock.After(milliseconds(5), [&] { order += 'c'; });
  });
  const TimerId never = clock.At(start + milliseconds(2), [&] { order += 'x'; });
  clock.Cancel(never);
  io.run();
  EXPECT_EQ(order, "abc");
}

TEST(ClockSchedulerTest, ATimerThatThrowsLeavesTheOthersGoing) {
  boost::asio::io_context io;
  ClockScheduler clock(io, true);
  std::string order;
  clock.At(milliseconds(0), [] { throw std::runtime_error("thrown"); });
  clock.At(milliseconds(0), [&] { order += 'a'; });
  EXPECT_THROW(io.run(), std::runtime_error);
  io.run();
  EXPECT_EQ(order, "a");
  io.restart();
  clock.After(milliseconds(1), [&] { order += 'b'; });
  io.run();
  EXPECT_EQ(order, "ab");
}

TEST(ClockSchedulerTest, SwitchingGoesOnFromTheTimeReached) {
  boost::asio::io_context io;
  ClockScheduler clock(io, false);
  clock.Advance(milliseconds(1000));
  bool ran = false;
  clock.After(milliseconds(2), [&] { ran = true; });
  clock.UseReal();
  EXPECT_GE(clock.Now(), milliseconds(1000));
  io.run();
  EXPECT_TRUE(ran);
  clock.UseVirtual();
  const Time stopped = clock.Now();
  EXPECT_GE(stopped, milliseconds(1002));
  EXPECT_EQ(clock.Now(), stopped);
}

}  // namespace
}  // namespace vm
