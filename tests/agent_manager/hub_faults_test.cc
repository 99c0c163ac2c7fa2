// What once ended, hung or fattened the hub, or reached a file, said to the real program again.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/agent_manager/programs.h"
#include "tests/support/process.h"
#include "tests/support/sanitized.h"

namespace {

using support::Process;
using support::SocketClient;

class HubFaultsTest : public testing::Test {
 protected:
  /// `more`: further members of the configuration.
  Process& Start(const std::string& modules, const std::string& more = "") {
    Configure(modules, more);
    hub_.emplace(std::vector<std::string>{kHub, "--config", folder_ / "hub.json"});
    return *hub_;
  }
  void Configure(const std::string& modules, const std::string& more = "") {
    std::ofstream(folder_ / "hub.json")
        << "{\"listen\": [\"unix:" + Socket() + "\"], \"modules\": [" + modules + "]" + more + "}";
  }
  std::string Socket() const { return folder_ / "hub.sock"; }
  std::string Shell(const std::string& name, const std::string& text,
                    const std::string& more = "") {
    const std::string script = folder_ / (name + ".sh");
    std::ofstream(script) << text;
    return "{\"name\": \"" + name + "\", \"dialect\": \"original\", \"command\": [\"/bin/sh\", \"" +
           script + "\"]" + more + "}";
  }
  /// The hub still answers.
  void ExpectAlive() {
    static int number = 0;
    const std::string tag = "alive" + std::to_string(++number);
    hub_->WriteLine("inq#" + tag + " Run");
    EXPECT_TRUE(hub_->Expect("rep#" + tag + " Run = LIVE")) << hub_->Seen() << hub_->ErrorText();
  }

  support::TempDir folder_;
  std::optional<Process> hub_;
};

TEST_F(HubFaultsTest, NoDefinitionOfAMacroEndsIt) {
  Process& hub = Start("");
  for (const std::string& definition :
       {std::string(R"({"grammar":"<bogus>","steps":[]})"),
        std::string(R"({"grammar":"<int a..b>"})"),
        "{\"grammar\":\"" + std::string(60000, '(') + "\"}", std::string(60000, '['),
        std::string(R"([{"parallel":[]}])"), std::string(R"([{"wait":{}}])"),
        std::string("[{\"let\":{\"a\":\"${\"}}]")}) {
    hub.WriteLine("to @AM-MCL def#1 B = " + definition);
    EXPECT_TRUE(hub.Expect("rep#1 B.error")) << definition.substr(0, 60);
  }
  ExpectAlive();
}

TEST_F(HubFaultsTest, AMacroThatSendsToItselfOrGrowsEndsWithALimit) {
  Process& hub = Start("");
  hub.WriteLine(R"(to @AM-MCL def X = {"steps":[],"finally":[{"send":"to @AM-MCL set X = 1"}]})");
  hub.WriteLine("to @AM-MCL set#1 X = 1");
  EXPECT_TRUE(hub.Expect("rep#1 X = 1"));
  hub.WriteLine(R"(to @AM-MCL def L = [{"request":"to @AM-MCL set M = 1"}])");
  hub.WriteLine(R"(to @AM-MCL def M = [{"request":"to @AM-MCL set L = 1"}])");
  hub.WriteLine("to @AM-MCL set#2 L = 1");
  EXPECT_TRUE(hub.Expect("rep#2 L.error")) << hub.Seen();
  std::string doubling = R"(to @AM-MCL def#3 D = [{"let":{"a":"0123456789"}})";
  for (int i = 0; i < 40; ++i) doubling += R"(,{"let":{"a":"${a}${a}"}})";
  hub.WriteLine(doubling + "]");
  hub.WriteLine("to @AM-MCL set#4 D = 1");
  EXPECT_TRUE(hub.Expect("rep#4 D.error = TOO_LONG")) << hub.Seen();
  ExpectAlive();
}

TEST_F(HubFaultsTest, AClientReadsAndDeletesNoFileOfTheHubsUser) {
  const std::string secret = folder_ / "secret", kept = folder_ / "kept";
  std::ofstream(secret) << "secret words";
  std::ofstream(kept) << "kept";
  Start("");
  const auto client = SocketClient::Unix(Socket());
  client->WriteLine("def A = x");
  client->WriteLine("set#1 A < " + secret);
  EXPECT_TRUE(client->Expect("rep#1 A.error = ACCESS"));
  client->WriteLine("to @AM-MCL def#2 R = [{\"remove\": \"${value}\"}]");
  EXPECT_TRUE(client->Expect("rep#2 R.error = ACCESS"));
  client->WriteLine("do#3 " + secret);
  EXPECT_TRUE(client->Expect("rep#3 do.error = ACCESS"));
  client->WriteLine("inq#4 A");
  EXPECT_TRUE(client->Expect("rep#4 A = x"));
  EXPECT_TRUE(std::filesystem::exists(kept));
}

TEST_F(HubFaultsTest, PipesAndDevicesAsFilesAreRefusedAtOnce) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  Process& hub = Start("{\"name\": \"TEST\", \"command\": [\"" + kModule + "\"]}");
  hub.WriteLine("def A = x");
  for (const std::string& file : {pipe, std::string("/dev/zero"), std::string("/dev/stdin")}) {
    hub.WriteLine("set#1 A < " + file);
    EXPECT_TRUE(hub.Expect("rep#1 A.error = ACCESS")) << file;
    hub.WriteLine("do#2 " + file);
    EXPECT_TRUE(hub.Expect("rep#2 do.error = ACCESS")) << file;
    hub.WriteLine("to @TEST set#3 X < " + file);
    EXPECT_TRUE(hub.Expect("rep#3 X.error = ACCESS")) << file << hub.Seen();
  }
  ExpectAlive();
}

TEST_F(HubFaultsTest, ReloadingWhileAConfiguredMacroRunsGoesOn) {
  const std::string macro = R"(, "macros": {"Long": [{"pause_ms": 3600000}]})";
  Process& hub = Start("", macro);
  hub.WriteLine("to @AM-MCL set#1 Long = x");
  hub.WriteLine("set#2 Reload = NOW");
  EXPECT_TRUE(hub.Expect("rep#2 Reload = NOW")) << hub.ErrorText();
  Configure("", R"(, "macros": {"Long": [{"jump": 1}]})");
  hub.WriteLine("set#3 Reload = NOW");
  EXPECT_TRUE(hub.Expect("rep#3 Reload.error = BAD_VALUE")) << hub.Seen();
  Configure("");
  hub.WriteLine("set#4 Reload = NOW");
  EXPECT_TRUE(hub.Expect("rep#4 Reload = NOW")) << hub.Seen();
  hub.WriteLine("to @AM-MCL set#5 Long = x");
  EXPECT_TRUE(hub.Expect("rep#5 Long.error = UNKNOWN_SLOT")) << "no longer configured";
  ExpectAlive();
}

TEST_F(HubFaultsTest, AMacroThatStopsAModuleItIsConnectedToIsSafe) {
  Process listening({kModule, "--listen", "unix:" + folder_ / "module"});
  ASSERT_TRUE(listening.ExpectError("listening on"));
  Process& hub = Start("{\"name\": \"FAR\", \"connect\": \"unix:" + folder_ / "module" + "\"}");
  hub.WriteLine(
      R"(to @AM-MCL def Both = [{"parallel": [[{"wait": {"from": "FAR", "slot": "X", "value": "9"}, "limit_ms": 60000}], [{"request": "to @AM set Stop = FAR"}]]}])");
  hub.WriteLine("to @FAR set#1 X = 1");
  ASSERT_TRUE(hub.Expect("rep#1 X = 1")) << hub.Seen() << hub.ErrorText();
  hub.WriteLine(
      "to @AM-MCL def Other = [{\"request\": \"to @FAR inq X\", \"limit_ms\": 60000}, "
      "{\"pause_ms\": 60000}]");
  hub.WriteLine("to @AM-MCL set#3 Other = x");
  hub.WriteLine("to @FAR set X = 2");
  hub.WriteLine("to @AM-MCL set#2 Both = x");
  EXPECT_TRUE(hub.Expect("rep#3 Other.error = UNAVAILABLE @FAR has gone")) << hub.Seen();
  ExpectAlive();
}

TEST_F(HubFaultsTest, BytesOfAModulesErrorsAreShownAsText) {
  Process& hub = Start(Shell("RAW",
                             "printf 'bad \\377\\033[31m bytes\\r\\n' >&2\n"
                             "while read -r line; do case $line in *EXIT*) exit 0;; esac; "
                             "done\n"));
  ASSERT_TRUE(hub.ExpectError("RAW INFO: bad")) << hub.ErrorText();
  std::optional<std::string> log;
  for (int i = 0; i < 200 && (!log || log->find("bad") == std::string::npos); ++i) {
    hub.WriteLine("inq#1 Module.RAW.log");
    log = hub.Expect("rep#1 Module.RAW.log");
  }
  ASSERT_TRUE(log);
  EXPECT_NE(log->find("bad \xEF\xBF\xBD [31m bytes"), std::string::npos) << *log;
}

TEST_F(HubFaultsTest, AModuleHasTheWholeTimeToStopThatItWasGiven) {
  const std::string marker = folder_ / "stopped well";
  Process& hub = Start(Shell("SLOW",
                             "while read -r line; do case $line in *EXIT*) exec >&-; sleep 1; "
                             "touch '" +
                                 marker + "'; exit 0;; esac; done\n",
                             ", \"stop_within_ms\": 20000"));
  hub.WriteLine("set#1 Stop = SLOW");
  EXPECT_TRUE(hub.Expect("rep#1 Stop = STOPPED")) << hub.Seen() << hub.ErrorText();
  EXPECT_TRUE(std::filesystem::exists(marker));
}

TEST_F(HubFaultsTest, MoreClientsThanDescriptorsAreTurnedAwayAndNobodyElseWaits) {
  if (support::kSanitized) GTEST_SKIP() << "the sanitizers need descriptors of their own";
  Configure("");
  const std::string command =
      "ulimit -n 40; exec '" + kHub + "' --config '" + folder_ / "hub.json'";
  hub_.emplace(std::vector<std::string>{"/bin/sh", "-c", command});
  ExpectAlive();
  const auto first = SocketClient::Unix(Socket());
  first->WriteLine("inq#1 Run");
  ASSERT_TRUE(first->Expect("rep#1 Run = LIVE"));
  std::vector<std::unique_ptr<SocketClient>> many;
  for (int i = 0; i < 60; ++i) {
    many.push_back(SocketClient::Unix(Socket()));
    many.back()->WriteLine("inq#1 Run");
  }
  ExpectAlive();
  first->WriteLine("inq#2 Run");
  EXPECT_TRUE(first->Expect("rep#2 Run = LIVE")) << hub_->ErrorText();
  EXPECT_TRUE(many.front()->Expect("rep#1 Run = LIVE"));
  EXPECT_FALSE(many.back()->Expect("rep#1 Run = LIVE")) << "it is told, by the end";
  many.clear();
  bool answered = false;  // once the hub has seen that the others are gone
  for (int tries = 0; tries < 200 && !answered; ++tries) {
    ExpectAlive();
    const auto late = SocketClient::Unix(Socket());
    late->WriteLine("inq#3 Run");
    answered = late->Expect("rep#3 Run = LIVE").has_value();
  }
  EXPECT_TRUE(answered) << hub_->ErrorText();
}

TEST_F(HubFaultsTest, AConfiguredModuleKeepsItsName) {
  Process& hub = Start(Shell("FIRM",
                             "echo 'to @AM set#n Name = OTHER'\nwhile read -r line; do case $line "
                             "in *EXIT*) exit 0;; *) echo \"tell heard $line\";; esac; done\n"));
  EXPECT_TRUE(hub.Expect("From @FIRM tell heard From @AM rep#n Name.error = ACCESS"))
      << hub.Seen() << hub.ErrorText();
}

TEST_F(HubFaultsTest, WhatAModuleHasStartedItselfEndsWithIt) {
  const std::string pid = folder_ / "pid";
  Process& hub = Start(
      "{\"name\": \"SHELL\", \"dialect\": \"original\", \"command\": "
      "\"sleep 600 & echo $! > '" +
      pid + "'; echo tell up; read line; exit 0\"}");
  ASSERT_TRUE(hub.Expect("From @SHELL tell up")) << hub.ErrorText();
  hub.WriteLine("set#1 Stop = SHELL");
  ASSERT_TRUE(hub.Expect("rep#1 Stop = STOPPED"));
  std::ifstream file(pid);
  pid_t child = 0;
  file >> child;
  ASSERT_GT(child, 0);
  const auto runs = [child] {  // it may wait for whoever adopted it to take its exit code
    std::ifstream stat("/proc/" + std::to_string(child) + "/stat");
    std::string number, name, state;
    stat >> number >> name >> state;
    return !state.empty() && state != "Z";
  };
  for (int tries = 0; runs() && tries < 1000; ++tries) ExpectAlive();
  EXPECT_FALSE(runs());
}

TEST_F(HubFaultsTest, AModuleThatSaidAWordBeforeItFailedIsTriedThreeTimes) {
  Process& hub = Start(
      "{\"name\": \"BAD\", \"command\": \"echo rep X = 1; echo 'no display' >&2; exit 1\", "
      "\"restart\": {\"when\": \"always\", \"first_ms\": 1}}");
  EXPECT_TRUE(hub.ExpectError("error: @BAD has failed to start 3 times")) << hub.ErrorText();
}

TEST_F(HubFaultsTest, AModuleThatFailsToStartIsAnErrorWithItsReasonAndIsGivenUp) {
  Process& hub = Start(
      "{\"name\": \"BAD\", \"command\": \"echo 'fsm: no display' >&2; exit 1\", "
      "\"restart\": {\"when\": \"always\", \"first_ms\": 1}}");
  EXPECT_TRUE(hub.ExpectError("error: @BAD ended with code 1 before it was ready: fsm: no display"))
      << hub.ErrorText();
  EXPECT_TRUE(hub.ExpectError(
      "error: @BAD has failed to start 2 times, it is not started again: fsm: no display"))
      << hub.ErrorText();
  hub.WriteLine("inq#1 Module.BAD.state");
  EXPECT_TRUE(hub.Expect("rep#1 Module.BAD.state = FAILED"));
  hub.WriteLine("inq#2 Module.BAD.log");
  const std::string reason = "ERROR fsm: no display";
  EXPECT_TRUE(hub.Expect("rep#2 Module.BAD.log = " + reason + " | " + reason)) << hub.Seen();
  EXPECT_TRUE(hub.ErrorText().contains("BAD ERROR: fsm: no display")) << hub.ErrorText();
  EXPECT_FALSE(hub.ErrorText().contains("BAD INFO")) << hub.ErrorText();
}

TEST_F(HubFaultsTest, TheNameOfAnExceptionIsAnError) {
  Process& hub = Start("{\"name\": \"PY\", \"command\": [\"python3\", \"-c\", \"import nope\"]}");
  EXPECT_TRUE(hub.ExpectError("PY ERROR: ModuleNotFoundError: No module named 'nope'"))
      << hub.ErrorText();
}

TEST_F(HubFaultsTest, AFloodOfQuestionsEndsNoModuleAndIsAnsweredWhole) {
  Process& hub = Start("{\"name\": \"M\", \"command\": [\"" + kModule + "\"]}");
  hub.WriteLine("to @M inq#first Run");
  ASSERT_TRUE(hub.Expect("rep#first Run = LIVE"));
  const auto client = SocketClient::Unix(Socket());
  constexpr int kQuestions = 20000;
  std::string flood = "set Subscribe = NONE\n";
  for (int i = 0; i < kQuestions; ++i) flood += "to @M inq Slots.files\nto @M inq#x Slots\n";
  std::thread writer([&] { client->Write(flood); });
  int answers = 0, errors = 0;
  for (std::optional<std::string> line; answers < kQuestions && (line = client->ReadLine());) {
    answers += line->find("rep#x Slots") != std::string::npos ? 1 : 0;
    errors += line->find(".error") != std::string::npos ? 1 : 0;
  }
  writer.join();
  EXPECT_EQ(answers, kQuestions);
  EXPECT_EQ(errors, 0);
  hub.WriteLine("inq#state Module.M.state");
  EXPECT_TRUE(hub.Expect("rep#state Module.M.state = READY")) << hub.ErrorText();
}

TEST_F(HubFaultsTest, WhoSpeaksNoMoreIsAnsweredAndThenLetGo) {
  Process& hub = Start("{\"name\": \"M\", \"command\": [\"" + kModule + "\"]}");
  hub.WriteLine("to @M inq#first Run");
  ASSERT_TRUE(hub.Expect("rep#first Run = LIVE"));
  for (const char* question : {"to @M inq#1 Run\n", "to @M inq#1 Run"}) {
    const auto client = SocketClient::Unix(Socket());
    client->Write(question);
    client->CloseInput();
    EXPECT_TRUE(client->Expect("rep#1 Run = LIVE")) << question;
    EXPECT_FALSE(client->ReadLine()) << "nothing more";
  }
}

TEST_F(HubFaultsTest, WhatIsUnansweredAtTheEndIsAnsweredStopped) {
  Process& hub = Start("");
  hub.WriteLine(R"(to @AM-MCL def Long = [{"pause_ms": 60000}])");
  const auto client = SocketClient::Unix(Socket());
  client->WriteLine("to @AM-MCL set#1 Long = 1");
  client->WriteLine("inq#2 Run");
  ASSERT_TRUE(client->Expect("rep#2 Run = LIVE"));
  hub.WriteLine("quit");
  EXPECT_TRUE(client->Expect("rep#1 Long.error = STOPPED the hub ends"));
}

TEST_F(HubFaultsTest, WhoDoesNotReadAtTheEndIsLeftBehindInOrder) {
  Process& hub = Start("");
  const auto client = SocketClient::Unix(Socket());
  std::string questions;
  for (int i = 0; i < 500; ++i) questions += "inq#x Slots\n";
  for (int i = 0; i < 20; ++i) client->Write(questions);  // more answers than the socket holds
  hub.WriteLine("set Subscribe = NONE");
  ExpectAlive();
  hub.WriteLine("quit");
  EXPECT_EQ(hub.Wait(), 0) << hub.ErrorText();
  EXPECT_EQ(hub.ErrorText().find("Sanitizer"), std::string::npos) << hub.ErrorText();
}

TEST_F(HubFaultsTest, AHundredThousandReportsLeaveNothingBehind) {
  Start("").WriteLine("set Subscribe = NONE");  // nobody reads what the console would hear
  ExpectAlive();
  const auto client = SocketClient::Unix(Socket());
  client->WriteLine("set#0 Name = FLOOD");
  ASSERT_TRUE(client->Expect("rep#0 Name = FLOOD"));
  const auto memory_kib = [this] {
    std::ifstream status("/proc/" + std::to_string(hub_->pid()) + "/status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
    }
    return 0L;
  };
  const long before = memory_kib();
  const std::string long_value(2000, 'x');
  for (int i = 0; i < 100000; ++i)
    client->WriteLine("rep Slot" + std::to_string(i) + " = " + long_value);
  client->WriteLine("inq#1 Run");
  ASSERT_TRUE(client->Expect("rep#1 Run = LIVE"));
  if (!support::kSanitized) {
    EXPECT_LT(memory_kib() - before, 20000);
  }
}

}  // namespace
