#include "agent_manager/session/periodic_task.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace am {
namespace {

using std::chrono::milliseconds;

TEST(PeriodicTaskTest, ATurnThatThrowsIsFollowedByTheNext) {
  boost::asio::io_context io;
  PeriodicTask task(io);
  int turns = 0;
  task.Start(milliseconds(1), [&] {
    if (++turns == 1) throw std::runtime_error("thrown");
    io.stop();
  });
  EXPECT_THROW(io.run(), std::runtime_error);
  io.run();
  EXPECT_EQ(turns, 2);
}

}  // namespace
}  // namespace am
