#include "agent_manager/supervision/process.h"

#include <gtest/gtest.h>
#include <sys/time.h>

#include <csignal>

namespace am {
namespace {

TEST(ProcessTest, ASignalThatComesMeanwhileHidesNoFailure) {
  struct sigaction quiet {};
  quiet.sa_handler = [](int) {};  // without SA_RESTART
  struct sigaction before {};
  sigaction(SIGALRM, &quiet, &before);
  const itimerval often{{0, 300}, {0, 300}}, never{};
  setitimer(ITIMER_REAL, &often, nullptr);
  ModuleConfig module;
  module.name = "X";
  module.command = {"/no/such/program"};
  int refused = 0;
  for (int i = 0; i < 100; ++i) refused += SpawnProcess(module) ? 0 : 1;
  setitimer(ITIMER_REAL, &never, nullptr);
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_EQ(refused, 100);
}

}  // namespace
}  // namespace am
