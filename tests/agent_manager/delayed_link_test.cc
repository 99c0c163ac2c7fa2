// Clock offsets over a network that delays: in a network namespace of the test's own.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/agent_manager/programs.h"
#include "tests/support/process.h"

namespace {

using support::Process;

/// A network: what is done to the loopback device, and how wrong an offset may be then, in ms.
struct Network {
  const char* name;
  const char* setup;
  double tolerance_ms;
};
class DelayedLinkTest : public testing::TestWithParam<Network> {};

TEST_P(DelayedLinkTest, TheHubKnowsWhereAFarClockStands) {
  const std::string enter =
      std::string("ip link set lo up") + (*GetParam().setup ? " && " : "") + GetParam().setup;
  if (std::system(("unshare -rn sh -c '" + enter + "' 2>/dev/null >&2").c_str()) != 0)
    GTEST_SKIP()
        << "no network of one's own with delays (unshare -rn as a user who may; tc of the Debian "
           "package iproute2; the kernel's sch_netem)";
  const support::TempDir folder;
  const std::string path = folder / "config.json";
  std::ofstream(path)
      << R"({"listen": ["tcp:127.0.0.1:7000"], "modules": [{"name": "NEAR", "command": [")"
      << kModule << R"("]}, {"name": "RUNNER", "dialect": "original", "command": "exec )" << kModule
      << R"( --connect tcp:127.0.0.1:7000 --name FAR"}]})";
  Process hub({"unshare", "-rn", "sh", "-c",
               enter + " && exec " + kHub + " --config " + path + " --serve"});
  hub.WriteLine("set Subscribe = FAR");
  ASSERT_TRUE(hub.Expect("From @FAR rep Run = LIVE")) << hub.ErrorText();
  const auto ask = [&hub](const std::string& line) {
    hub.WriteLine(line);
    const auto answer = hub.Expect("rep#q ");
    return answer ? answer->substr(answer->find(" = ") + 3) : "";
  };
  // Offsets are to the hub's clock; their difference is that of the two modules' beginnings.
  const auto offset = [&](const std::string& name) {
    std::istringstream words(ask("inq#q Clocks"));
    for (std::string word; words >> word;) {
      if (word == name && words >> word) return std::atof(word.c_str());
    }
    return std::nan("");
  };
  const double true_difference = std::atof(ask("to @NEAR inq#q Epoch").c_str()) -
                                 std::atof(ask("to @FAR inq#q Epoch").c_str());
  double difference = offset("FAR") - offset("NEAR");
  for (int i = 0; i < 200 && std::isnan(difference); ++i) {  // until it has been measured
    ask("to @FAR inq#q X");
    difference = offset("FAR") - offset("NEAR");
  }
  EXPECT_NEAR(difference, true_difference, GetParam().tolerance_ms) << GetParam().name;
}

INSTANTIATE_TEST_SUITE_P(
    Networks, DelayedLinkTest,
    testing::Values(Network{"plain", "", 5},
                    Network{"slow", "tc qdisc add dev lo root netem delay 50ms", 5},
                    Network{"uneven", "tc qdisc add dev lo root netem delay 40ms 8ms", 8}),
    [](const auto& network) { return network.param.name; });

}  // namespace
