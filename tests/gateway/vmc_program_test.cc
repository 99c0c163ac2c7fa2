// The face, the hub and vmc on the virtual clock; oscdump of liblo, which knows nothing of us,
// reads what is sent.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support/mosquitto.h"
#include "tests/support/process.h"

namespace {

using support::Process;

/// The configuration of a hub with the face and vmc, which sends to that port.
std::string ConfigFor(const support::TempDir& folder, const std::string& port) {
  std::ofstream(folder / "c.json")
      << R"({"clock": "virtual", "modules": [{"name": "FSM", "command": [")" GALATEA_BIN_DIR
         R"(/fsm", "--headless"]}, {"name": "VMC", "after": ["FSM"], "command": [")" GALATEA_BIN_DIR
         R"(/vmc", "--to", "127.0.0.1:)"
      << port << "\"]}]}";
  return folder / "c.json";
}

TEST(VmcProgramTest, AnAvatarIsToldWhatTheFaceDoes) {
  if (std::system("command -v oscdump >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "needs oscdump (Debian: liblo-tools)";
  support::TempDir folder;
  const std::string port = std::to_string(support::FreePort());
  // It tells nothing when it listens, so it is looked for in the kernel's table.
  Process listener({"stdbuf", "-oL", "oscdump", port});
  char hex[16];
  std::snprintf(hex, sizeof hex, ":%04X ", static_cast<unsigned>(std::stoi(port)));
  const std::string wait =
      std::string("until grep -q '") + hex + "' /proc/net/udp; do sleep 0.05; done";
  ASSERT_EQ(std::system(("timeout 20 sh -c \"" + wait + "\"").c_str()), 0);
  const std::string config = ConfigFor(folder, port);
  Process hub({GALATEA_BIN_DIR "/agent_manager", "--config", config});
  hub.WriteLine("set Wait = 100");
  hub.WriteLine("to @FSM set AU = 12 1 1");
  hub.WriteLine("to @FSM set HeadRotAbs.1 = 0 20 0");
  hub.WriteLine("to @FSM set LipSync.pho = pau 100 m 100 aa 300 pau 100");
  hub.WriteLine("to @FSM set Speak = NOW");
  hub.WriteLine("set Wait = 1500");
  hub.WriteLine("to @VMC inq#1 Sent");
  const std::string sent = hub.Expect("rep#1 Sent = ").value_or("");
  hub.CloseInput();
  EXPECT_EQ(hub.Wait(), 0) << hub.ErrorText();
  const int bundles = std::atoi(sent.substr(sent.rfind(' ')).c_str());
  EXPECT_GT(bundles, 15) << sent << hub.Seen() << hub.ErrorText();

  // The greatest of each weight, and the last of each bone.
  std::map<std::string, double> most;
  std::map<std::string, std::string> bones;
  int applied = 0;
  while (applied < bundles) {
    const auto line = listener.ReadLine();
    ASSERT_TRUE(line) << "after " << applied << " of " << bundles << " bundles";
    applied += line->contains("/VMC/Ext/Blend/Apply") ? 1 : 0;
    if (const auto at = line->find("/VMC/Ext/Blend/Val sf \""); at != std::string::npos) {
      const std::string rest = line->substr(at + 23);
      const std::size_t end = rest.find('"');
      double& value = most[rest.substr(0, end)];
      value = std::max(value, std::atof(rest.c_str() + end + 1));
    }
    if (const auto at = line->find("/VMC/Ext/Bone/Pos sfffffff \""); at != std::string::npos) {
      const std::string rest = line->substr(at + 28);
      bones[rest.substr(0, rest.find('"'))] = rest;
    }
  }
  EXPECT_NEAR(most["Joy"], 1, 0.01);
  EXPECT_GT(most["A"], 0.5);
  EXPECT_LT(most["U"], 0.2);
  ASSERT_TRUE(bones.contains("Head"));
  double x = 0, y = 0, z = 0, a = 0, b = 0, c = 0, w = 0;
  ASSERT_EQ(std::sscanf(bones["Head"].c_str(), "Head\" %lf %lf %lf %lf %lf %lf %lf", &x, &y, &z, &a,
                        &b, &c, &w),
            7)
      << bones["Head"];
  EXPECT_NEAR(b, -std::sin(5 * 3.14159265 / 180), 0.01) << "half of 20 degrees, and half an angle";
}

TEST(VmcProgramTest, UnrealIsToldTheSameByLiveLink) {
  support::TempDir folder;
  Process listener(
      {"python3", GALATEA_SOURCE_DIR "/tests/gateway/live_link_listener.py", "--packets", "12"});
  const std::string port = listener.ReadLine().value_or("");
  const std::string config = ConfigFor(folder, port);
  Process hub({GALATEA_BIN_DIR "/agent_manager", "--config", config});
  hub.WriteLine("to @VMC set Protocol = LIVELINK");
  hub.WriteLine("to @VMC set Subject = Lady");
  hub.WriteLine("set Wait = 100");
  hub.WriteLine("to @FSM set AU = 27 1 1");
  hub.WriteLine("to @FSM set HeadRotAbs.1 = 0 18 0");
  hub.WriteLine("to @FSM set LipSync.pho = pau 100 m 100 aa 300 pau 100");
  hub.WriteLine("to @FSM set Speak = NOW");
  hub.WriteLine("set Wait = 1500");
  nlohmann::json last;
  double most = 0;
  for (int i = 0; i < 12; ++i) {
    const auto line = listener.ReadLine();
    ASSERT_TRUE(line) << "after " << i << " packets: " << listener.ErrorText();
    const auto packet = nlohmann::json::parse(*line);
    if (!last.is_null()) {
      EXPECT_GE(packet["seconds"], last["seconds"]);
    }
    most = std::max(most, packet["values"][17].get<double>());
    last = packet;
  }
  EXPECT_EQ(listener.Wait(), 0) << listener.ErrorText();
  EXPECT_EQ(last["subject"], "Lady");
  EXPECT_GT(most, 0.3) << "jawOpen is the eighteenth";
  EXPECT_NEAR(last["values"][52].get<double>(), 0.1, 0.001) << "18 degrees to the viewer's right";
  EXPECT_NEAR(last["values"][53].get<double>(), 0, 0.01);
}

}  // namespace
