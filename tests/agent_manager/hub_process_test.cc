// The hub as a process, with small modules: started, spoken to, killed, replayed.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "tests/agent_manager/programs.h"
#include "tests/support/process.h"

namespace {

using support::Process;
using support::SocketClient;

std::string WriteConfig(const support::TempDir& folder, const std::string& text) {
  const std::string path = folder / "config.json";
  std::ofstream(path) << text;
  return path;
}

std::string ModuleJson(const std::string& more = "") {
  return "{\"name\": \"TEST\", \"command\": [\"" + kModule + "\"]" + more + "}";
}

TEST(HubProcessTest, StartsAModuleSpeaksToItAndEndsInOrder) {
  const support::TempDir folder;
  Process hub({kHub, "--config", WriteConfig(folder, "{\"modules\": [" + ModuleJson() + "]}")});
  hub.WriteLine("to @TEST set#1 X = 5");
  EXPECT_TRUE(hub.Expect("From @TEST rep#1 X = 5")) << hub.Seen() << hub.ErrorText();
  hub.WriteLine("to @NOBODY set#2 X = 5");
  EXPECT_TRUE(hub.Expect("rep#2 X.error = UNKNOWN_MODULE"));
  hub.CloseInput();
  EXPECT_TRUE(hub.Expect("From @TEST rep Run = EXIT")) << hub.Seen();
  EXPECT_EQ(hub.Wait(), 0);
}

TEST(HubProcessTest, StartsAModuleWrittenInPython) {
  const support::TempDir folder;
  Process hub(
      {kHub, "--config",
       WriteConfig(
           folder,
           "{\"modules\": [{\"name\": \"LAMP\", \"command\": [\"python3\", \"" GALATEA_SOURCE_DIR
           "/examples/lamp_module.py\"]}]}")});
  hub.WriteLine("to @LAMP set#1 Lamp = ON");
  EXPECT_TRUE(hub.Expect("From @LAMP rep#1 Lamp = ON")) << hub.Seen() << hub.ErrorText();
  hub.WriteLine("to @LAMP set#2 Lamp = PURPLE");
  EXPECT_TRUE(hub.Expect("rep#2 Lamp.error = BAD_VALUE")) << hub.Seen();
  hub.CloseInput();
  EXPECT_EQ(hub.Wait(), 0);
}

TEST(HubProcessTest, OnTheVirtualClockTenSecondsOfWorkTakeNoTimeAndAreExact) {
  const support::TempDir folder;
  Process hub(
      {kHub, "--config",
       WriteConfig(folder, "{\"clock\": \"virtual\", \"modules\": [" + ModuleJson() + "]}")});
  hub.Write(
      "to @TEST set#1 Work = 10000\nset Wait = 500\nto @TEST inq#2 Clock\nset Wait = IDLE\nto "
      "@TEST inq#3 Clock\n");
  hub.CloseInput();
  EXPECT_TRUE(hub.Expect("rep#2 Clock = 10500")) << hub.Seen() << hub.ErrorText();
  EXPECT_TRUE(hub.Expect("From @TEST tell worked until 20000")) << hub.Seen();
  EXPECT_TRUE(hub.Expect("rep#3 Clock = 20000")) << hub.Seen();
  EXPECT_EQ(hub.Wait(), 0);
}

TEST(HubProcessTest, AModuleThatLeavesTakesItsNextEventAlong) {
  const support::TempDir folder;
  const std::string leaver = folder / "leaver.py";
  // Names an event every half a second.
  std::ofstream(leaver) << R"(import sys
for line in sys.stdin:
    words = line.split()
    command, _, tag = words[0].partition("#")
    if tag and words[1] == "Clock":
        now = words[3] if command == "set" else "0"
        print(f"rep#{tag} Clock = {now} {float(now) // 500 * 500 + 500:.0f}", flush=True)
    elif tag:
        print(f"rep#{tag} {words[1]}.error = UNKNOWN_SLOT none", flush=True)
)";
  Process hub(
      {kHub, "--config",
       WriteConfig(folder, R"({"clock": "virtual", "modules": [{"name": "LEAVER", "restart": )"
                           R"("never", "command": ["python3", ")" +
                               leaver + "\"]}]}")});
  hub.Write("set Wait = 700\ninq#1 Module.LEAVER.pid\n");
  const auto pid = hub.Expect("rep#1 Module.LEAVER.pid = ");
  ASSERT_TRUE(pid) << hub.Seen() << hub.ErrorText();
  kill(std::stoi(pid->substr(pid->rfind(' ') + 1)), SIGKILL);
  ASSERT_TRUE(hub.Expect("tell @LEAVER has gone")) << hub.Seen() << hub.ErrorText();
  hub.Write("set Wait = 1000\ninq#2 Clock\n");
  EXPECT_TRUE(hub.Expect("rep#2 Clock = 11700")) << hub.Seen() << hub.ErrorText();
}

TEST(HubProcessTest, AKilledModuleIsReportedAndStartedAgain) {
  const support::TempDir folder;
  Process hub(
      {kHub, "--config",
       WriteConfig(folder, "{\"modules\": [" + ModuleJson(", \"restart\": \"always\"") + "]}")});
  hub.WriteLine("inq#1 Processes");
  const auto processes = hub.Expect("rep#1 Processes = TEST RUNNING ");
  ASSERT_TRUE(processes) << hub.Seen();
  const int pid = std::stoi(processes->substr(processes->rfind(' ') + 1));
  hub.WriteLine("to @TEST set#2 Work = 60000");
  hub.WriteLine("to @TEST inq#3 X");
  ASSERT_TRUE(hub.Expect("rep#3 X = 0"));
  kill(pid, SIGKILL);
  EXPECT_TRUE(hub.Expect("rep#2 Work.error = UNAVAILABLE @TEST has gone (killed by signal 9"))
      << hub.Seen();
  EXPECT_TRUE(hub.Expect("From @TEST rep Run = LIVE")) << hub.Seen() << hub.ErrorText();
  hub.WriteLine("to @TEST set#4 X = 7");
  EXPECT_TRUE(hub.Expect("rep#4 X = 7"));
  hub.CloseInput();
  EXPECT_EQ(hub.Wait(), 0);
}

TEST(HubProcessTest, WhatIsTypedWhileAModuleStartsAgainReachesItOnceItHasAnswered) {
  const support::TempDir folder;
  const std::string marker = folder / "second", gate = folder / "gate",
                    script = folder / "module.sh";
  ASSERT_EQ(mkfifo(gate.c_str(), 0600), 0);
  // Started a second time it says LIVE, and answers the hub's question only when the gate opens.
  std::ofstream(script)
      << "answer() { echo \"rep$(echo \"$1\" | sed 's/^[a-z]*\\(#[^ ]*\\) "
         "\\([^ ]*\\).*/\\1 \\2/') = 0\"; }\n"
      << "echo 'rep Run = LIVE'\nread question\n"
      << "if [ -e " << marker << " ]; then echo tell ASKED; read go <" << gate << "; fi\ntouch "
      << marker << "\nanswer \"$question\"\n"
      << "while read -r line; do case $line in\n*Die*) exit 1;;\n*EXIT*) exit 0;;\n"
      << "*#*) answer \"$line\";;\nesac; done\n";
  Process hub({kHub, "--config",
               WriteConfig(folder,
                           "{\"modules\": [{\"name\": \"TEST\", \"restart\": \"always\", "
                           "\"command\": [\"/bin/sh\", \"" +
                               script + "\"]}]}")});
  hub.WriteLine("to @TEST set#1 X = 1");
  ASSERT_TRUE(hub.Expect("rep#1 X = 0")) << hub.Seen() << hub.ErrorText();
  hub.WriteLine("to @TEST set#2 Die = 1");
  ASSERT_TRUE(hub.Expect("tell ASKED")) << hub.Seen() << hub.ErrorText();
  hub.WriteLine("to @TEST set#3 X = 7");
  std::ofstream(gate) << "go\n";
  EXPECT_TRUE(hub.Expect("rep#3 X = 0")) << hub.Seen() << hub.ErrorText();
  hub.CloseInput();
  EXPECT_EQ(hub.Wait(), 0);
}

TEST(HubProcessTest, ClientsAndModulesComeOverASocket) {
  const support::TempDir folder;
  const std::string socket = folder / "hub.sock";
  Process hub({kHub, "--no-console", "--config",
               WriteConfig(folder, "{\"listen\": [{\"at\": \"unix:" + socket +
                                       "\", \"role\": \"owner\"}], \"modules\": []}")});
  const auto client = SocketClient::Unix(socket);
  Process module({kModule, "--connect", "unix:" + socket, "--name", "FAR"});
  client->WriteLine("to @AM set#0 Subscribe = *");
  ASSERT_TRUE(client->Expect("rep#0 Subscribe"));
  ASSERT_TRUE(client->Expect("From @FAR rep Run = LIVE")) << client->Seen();
  client->WriteLine("to @FAR set#1 X = 3");
  client->WriteLine("to @FAR inq#2 X");
  EXPECT_TRUE(client->Expect("From @FAR rep#2 X = 3")) << client->Seen();
  client->WriteLine("to @AM set Run = EXIT");
  EXPECT_EQ(hub.Wait(), 0) << hub.ErrorText();
}

TEST(HubProcessTest, ASessionLogIsPlayedAgain) {
  const support::TempDir folder;
  const std::string config =
      WriteConfig(folder, "{\"clock\": \"virtual\", \"modules\": [" + ModuleJson() + "]}");
  std::string logs[2];
  for (int i = 0; i < 2; ++i) {
    const std::string log = folder / ("session" + std::to_string(i) + ".log");
    std::vector<std::string> command{kHub, "--config", config, "--log", log};
    if (i == 1) command.insert(command.end(), {"--replay", folder / "session0.log"});
    Process hub(command);
    if (i == 0) hub.Write("to @TEST set X = 5\nset Wait = 1500\nto @TEST set X = 6\n");
    hub.CloseInput();
    hub.ReadAll();
    EXPECT_EQ(hub.Wait(), 0) << hub.ErrorText();
    std::ifstream file(log);
    for (std::string line; std::getline(file, line);) {
      const std::string sender = i == 0 ? "\tCONSOLE\t" : "\tREPLAY\t";
      const std::size_t at = line.find(sender + "TEST\t");
      if (at == std::string::npos) continue;
      logs[i] += line.substr(0, at + 1) + line.substr(at + sender.size()) + "\n";
    }
  }
  EXPECT_NE(logs[0].find("11500\tTEST\tto @TEST set X = 6"), std::string::npos) << logs[0];
  EXPECT_EQ(logs[0], logs[1]) << "the same lines at the same times";
}

TEST(HubProcessTest, LinesOfAScriptArePlayedAgainOnce) {
  const support::TempDir folder;
  const std::string script = folder / "script";
  std::ofstream(script) << "to @TEST set X = 2\nto @TEST set X = 3\n";
  const std::string config =
      WriteConfig(folder, "{\"clock\": \"virtual\", \"modules\": [" + ModuleJson() + "]}");
  std::ptrdiff_t said[2];
  for (int i = 0; i < 2; ++i) {
    const std::string log = folder / ("session" + std::to_string(i) + ".log");
    std::vector<std::string> command{kHub, "--config", config, "--log", log};
    if (i == 1) command.insert(command.end(), {"--replay", folder / "session0.log"});
    Process hub(command);
    if (i == 0) hub.Write("do " + script + "\nset Wait = 100\n");
    hub.CloseInput();
    hub.ReadAll();
    EXPECT_EQ(hub.Wait(), 0) << hub.ErrorText();
    std::ifstream file(log);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    said[i] = 0;
    for (std::size_t at = 0; (at = text.find("\tto @TEST set X = ", at)) != std::string::npos; ++at)
      ++said[i];
    const std::string sender = i == 0 ? "CONSOLE" : "REPLAY";
    EXPECT_NE(text.find("\t" + sender + ":do\tTEST\tto @TEST set X = 2"), std::string::npos)
        << text;
  }
  EXPECT_EQ(said[0], 2);
  EXPECT_EQ(said[0], said[1]) << "each line once, not again by who had caused it";
}

TEST(HubProcessTest, AWorldThatRefusesIsOneSentence) {
  const support::TempDir folder;
  Process missing(
      {kHub, "--config",
       WriteConfig(folder,
                   "{\"modules\": [{\"name\": \"X\", \"command\": [\"/nonexistent/program\"]}]}")});
  EXPECT_EQ(missing.Wait(), 1);
  const std::string text = missing.ErrorText();
  const std::string why = "agent_manager: @X: cannot start '/nonexistent/program': No such file";
  EXPECT_NE(text.find(why), std::string::npos) << text;
  EXPECT_EQ(text.find(why), text.rfind(why)) << "said once: " << text;
  Process bad({kHub, "--config", WriteConfig(folder, "{\n \"modules\": 5}")});
  EXPECT_EQ(bad.Wait(), 1);
  EXPECT_NE(bad.ErrorText().find("line 2: modules: found 5, expected a list of modules"),
            std::string::npos)
      << bad.ErrorText();
}

TEST(HubProcessTest, TerminationStopsTheModulesInOrder) {
  const support::TempDir folder;
  Process hub({kHub, "--config", WriteConfig(folder, "{\"modules\": [" + ModuleJson() + "]}")});
  ASSERT_TRUE(hub.Expect("From @TEST rep Run = LIVE")) << hub.ErrorText();
  hub.Terminate();
  EXPECT_TRUE(hub.Expect("From @TEST rep Run = EXIT"));
  EXPECT_EQ(hub.Wait(), 0);
}

}  // namespace
