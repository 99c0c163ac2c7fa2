#include "vm_protocol/runtime/module_server.h"

#include <gtest/gtest.h>

#include <boost/asio/post.hpp>
#include <functional>

namespace vm {
namespace {

class IdleModule final : public Module {
 public:
  SlotMachine& slots() override { return slots_; }

 private:
  SlotMachine slots_{"TEST"};
};

TEST(ModuleServerTest, EndsThoughSomethingElseOfTheProcessNeverDoes) {
  boost::asio::io_context io;
  ClockScheduler clock(io, true);
  IdleModule module;
  ModuleServer server(io, clock, module, {});
  int rounds = 0;
  const std::function<void()> again = [&] {
    ++rounds;
    boost::asio::post(io, again);
  };
  boost::asio::post(io, again);
  server.RequestStop();
  EXPECT_EQ(server.Run(), 0);
  EXPECT_GT(rounds, 0) << "what closing has queued is still done";
}

}  // namespace
}  // namespace vm
