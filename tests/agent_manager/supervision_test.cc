// Modules as processes: their order, health, limits, output, and changes of the configuration.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <memory>
#include <vector>

#include "tests/agent_manager/programs.h"
#include "tests/support/process.h"
#include "tests/support/sanitized.h"

namespace {

using support::Process;

class SupervisionTest : public testing::Test {
 protected:
  void Configure(const std::string& modules) {
    std::ofstream(path_) << "{\"modules\": [" << modules << "]}";
  }
  static std::string Module(const std::string& name, const std::string& more = "") {
    return "{\"name\": \"" + name + "\", \"command\": [\"" + kModule + "\"]" + more + "}";
  }
  static std::string Shell(const std::string& name, const std::string& script,
                           const std::string& more = "") {
    return "{\"name\": \"" + name + "\", \"dialect\": \"original\", \"command\": \"" + script +
           "\"" + more + "}";
  }
  std::string Ask(Process& hub, const std::string& slot) {
    const std::string tag = "q" + std::to_string(++asked_);
    hub.WriteLine("inq#" + tag + " " + slot);
    const auto answer = hub.Expect("rep#" + tag + " ");
    return answer ? answer->substr(answer->find(" = ") + 3) : "";
  }

  support::TempDir folder_;
  std::string path_ = folder_ / "config.json";
  int asked_ = 0;
};

TEST_F(SupervisionTest, AModuleIsStartedOnceThoseBeforeItAreReady) {
  // LATER notes what FIRST had said by the time it was started.
  const std::string said = folder_ / "said";
  Configure(Shell("LATER", "cat " + said + " >&2; cat >/dev/null", ", \"after\": [\"FIRST\"]") +
            "," +
            Shell("FIRST", "read q; echo up >" + said + "; echo rep Run = LIVE; cat >/dev/null",
                  ", \"ready\": \"Run = LIVE\""));
  Process hub({kHub, "--config", path_});
  EXPECT_TRUE(hub.ExpectError("LATER INFO: up")) << hub.ErrorText();
  EXPECT_EQ(Ask(hub, "Module.LATER.state"), "READY");
  EXPECT_EQ(Ask(hub, "Module.LATER.output"), "INFO up");
}

TEST_F(SupervisionTest, AModuleThatDoesNotBecomeReadyIsEndedByForce) {
  Configure(Shell("SLOW", "cat >/dev/null",
                  ", \"ready\": \"Run = LIVE\", \"ready_within_ms\": 150, \"restart\": \"never\""));
  Process hub({kHub, "--config", path_});
  EXPECT_TRUE(hub.ExpectError("@SLOW killed by signal 9, Killed (not ready within 150 ms)"))
      << hub.ErrorText();
  EXPECT_EQ(Ask(hub, "Module.SLOW.state"), "ENDED");
}

TEST_F(SupervisionTest, AModuleThatStopsAnsweringIsEndedAndStartedAgain) {
  Configure(Module("TEST",
                   ", \"health\": {\"every_ms\": 100, \"within_ms\": 1000, \"misses\": 2}, "
                   "\"restart\": {\"when\": \"always\", \"first_ms\": 0}"));
  Process hub({kHub, "--config", path_});
  hub.WriteLine("to @TEST set#1 X = 1");
  ASSERT_TRUE(hub.Expect("rep#1 X = 1")) << hub.ErrorText();
  kill(std::stoi(Ask(hub, "Module.TEST.pid")), SIGSTOP);
  EXPECT_TRUE(hub.ExpectError("(did not answer inq Run 2 times in a row)")) << hub.ErrorText();
  ASSERT_TRUE(hub.Expect("From @TEST rep Run = LIVE")) << hub.ErrorText();
  hub.WriteLine("to @TEST set#2 X = 2");
  EXPECT_TRUE(hub.Expect("rep#2 X = 2")) << hub.Seen() << hub.ErrorText();
  EXPECT_EQ(Ask(hub, "Module.TEST.starts"), "2");
  EXPECT_NE(Ask(hub, "Module.TEST.ending").find("did not answer"), std::string::npos);
  EXPECT_EQ(Ask(hub, "Module.TEST.failed"), "YES");
}

TEST_F(SupervisionTest, AModuleThatAlwaysDiesIsGivenUp) {
  Configure(Shell("DIES", "echo 'dies: error: no luck' >&2; exit 3",
                  ", \"restart\": {\"when\": \"always\", \"first_ms\": 1, \"tries\": 3}"));
  Process hub({kHub, "--config", path_});
  EXPECT_TRUE(
      hub.ExpectError("error: @DIES ended 4 times within 60000 ms, it is not started again: "
                      "dies: error: no luck"))
      << hub.ErrorText();
  EXPECT_EQ(Ask(hub, "Module.DIES.state"), "FAILED");
  EXPECT_EQ(Ask(hub, "Module.DIES.ending"), "ended with code 3");
  EXPECT_NE(Ask(hub, "Module.DIES.log").find("ERROR dies: error: no luck"), std::string::npos);
}

TEST_F(SupervisionTest, LimitsHoldInTheProcess) {
  Configure(Shell("LIMITED", "ulimit -n >&2; ulimit -t >&2; nice >&2; cat >/dev/null",
                  ", \"limits\": {\"files\": 77, \"cpu_s\": 55, \"nice\": 3}"));
  Process hub({kHub, "--config", path_});
  EXPECT_TRUE(hub.ExpectError("LIMITED INFO: 77")) << hub.ErrorText();
  EXPECT_TRUE(hub.ExpectError("LIMITED INFO: 55")) << hub.ErrorText();
}

TEST_F(SupervisionTest, StopStartAndRestartByHand) {
  Configure(Module("TEST"));
  Process hub({kHub, "--config", path_});
  hub.WriteLine("set#1 Stop = TEST");
  EXPECT_TRUE(hub.Expect("rep#1 Stop = STOPPED")) << hub.ErrorText();
  hub.WriteLine("to @TEST set#2 X = 1");
  EXPECT_TRUE(hub.Expect("rep#2 X.error = UNKNOWN_MODULE"));
  hub.WriteLine("set#3 Start = TEST");
  EXPECT_TRUE(hub.Expect("rep#3 Start = READY"));
  hub.WriteLine("to @TEST set#4 X = 4");
  EXPECT_TRUE(hub.Expect("rep#4 X = 4"));
  hub.WriteLine("set#5 Restart = TEST");
  EXPECT_TRUE(hub.Expect("rep#5 Restart = READY"));
  hub.WriteLine("to @TEST inq#6 X");
  EXPECT_TRUE(hub.Expect("rep#6 X = 0")) << "a new process";
  hub.WriteLine("set#7 Stop = NOBODY");
  EXPECT_TRUE(hub.Expect("rep#7 Stop.error = UNKNOWN_MODULE @NOBODY is not configured"));
}

TEST_F(SupervisionTest, ReloadingTouchesOnlyWhatChanged) {
  Configure(Module("SAME") + "," + Module("CHANGED") + "," + Module("GONE"));
  Process hub({kHub, "--config", path_});
  const std::string same = Ask(hub, "Module.SAME.pid"), changed = Ask(hub, "Module.CHANGED.pid");
  Configure(Module("SAME") + "," + Module("CHANGED", ", \"env\": {\"A\": \"1\"}") + "," +
            Module("NEW"));
  hub.Signal(SIGHUP);
  ASSERT_TRUE(hub.ExpectError("the configuration was read again")) << hub.ErrorText();
  hub.WriteLine("set#1 Start = NEW");
  EXPECT_TRUE(hub.Expect("rep#1 Start = READY")) << hub.ErrorText();
  hub.WriteLine("to @NEW set#2 X = 2");
  EXPECT_TRUE(hub.Expect("rep#2 X = 2"));
  EXPECT_EQ(Ask(hub, "Module.SAME.pid"), same);
  EXPECT_EQ(Ask(hub, "Module.SAME.starts"), "1");
  std::ofstream(path_) << "{ nonsense";
  hub.WriteLine("set#3 Reload = NOW");
  EXPECT_TRUE(hub.Expect("rep#3 Reload.error = SYNTAX")) << hub.Seen();
  hub.WriteLine("to @SAME set#4 X = 4");
  EXPECT_TRUE(hub.Expect("rep#4 X = 4")) << "what ran goes on";
  for (std::string now = changed; now == changed || now == "-1";)  // until it has been replaced
    now = Ask(hub, "Module.CHANGED.pid");
  EXPECT_EQ(Ask(hub, "Module.CHANGED.starts"), "2");
}

TEST_F(SupervisionTest, AModuleWhoseNextEventIsAlwaysOverIsEndedAndTimeGoesOn) {
  const std::string script = folder_ / "liar.sh";
  std::ofstream(script)
      << "while read -r line; do\n"
         "  tag=${line#*#}; tag=${tag%% *}\n"
         "  case $line in *EXIT*) exit 0;; [si][en][tq]*) echo \"rep#$tag Clock = 0 0 "
         "IDLE\";; esac\n"
         "done\n";
  std::ofstream(path_) << R"({"clock": "virtual", "modules": [{"name": "LIAR", "restart": "never",
                            "command": ["/bin/sh", ")"
                       << script << "\"]}]}";
  Process hub({kHub, "--config", path_});
  hub.WriteLine("set Wait = 1000");
  EXPECT_EQ(Ask(hub, "Clock"), "11000") << hub.ErrorText();
  EXPECT_TRUE(hub.ExpectError("@LIAR does not follow the clock: it names 0 as its next event"))
      << hub.ErrorText();
}

TEST_F(SupervisionTest, AModuleThatLeavesItsProcessGroupIsEndedAllTheSame) {
  const std::string script = folder_ / "escape.py";
  std::ofstream(script) << "import os, signal, sys\n"
                           "signal.signal(signal.SIGTERM, signal.SIG_IGN)\n"
                           "os.setpgid(0, os.getpgid(os.getppid()))\n"
                           "print('rep Run = LIVE', flush=True)\n"
                           "while True: signal.pause()\n";
  Configure(R"({"name": "ESCAPE", "dialect": "original", "ready": "Run = LIVE", "restart": "never",
                "stop_within_ms": 50, "command": ["python3", ")" +
            script + "\"]}");
  Process hub({kHub, "--config", path_});
  hub.WriteLine("set#1 Start = ESCAPE");
  ASSERT_TRUE(hub.Expect("rep#1 Start = READY")) << hub.ErrorText();
  hub.WriteLine("set#2 Stop = ESCAPE");
  EXPECT_TRUE(hub.Expect("rep#2 Stop = STOPPED")) << hub.ErrorText();
}

TEST_F(SupervisionTest, AModuleThatEndsInOrderBeforeItIsReadyIsGivenUpToo) {
  Configure(
      "{\"name\": \"BRIEF\", \"command\": \"exit 0\", \"restart\": {\"when\": \"always\", "
      "\"first_ms\": 1, \"tries\": 100000}}");
  Process hub({kHub, "--config", path_});
  EXPECT_TRUE(hub.ExpectError("@BRIEF has failed to start 3 times")) << hub.ErrorText();
  EXPECT_EQ(Ask(hub, "Module.BRIEF.state"), "FAILED") << "the console goes on";
}

TEST_F(SupervisionTest, HelpTakesTheNameOfAModuleAndMisspeltNamesAndCommandsAreTold) {
  Configure(Module("TEST"));
  Process hub({kHub, "--config", path_});
  const auto answered = [&hub](const std::string& line, const std::string& answer) {
    hub.WriteLine(line);
    EXPECT_TRUE(hub.Expect(answer)) << line << "\n" << hub.Seen();
  };
  answered("help TEST", "# the slots of @TEST;");
  EXPECT_TRUE(hub.Expect("From @TEST rep Slots = ")) << hub.Seen();
  answered("help @TSET", "# there is no @TSET, did you mean 'TEST'?; help takes one of: AM ");
  answered("help me please", "# help takes the name of a module or nothing");
  answered("quit now", "# quit takes no words");
  answered("sett X = 1", "did you mean 'set'?");
  answered("to @test inq X", "there is no @test (inq Modules lists them), did you mean 'TEST'?");
}

TEST_F(SupervisionTest, QuitEndsAHubWhoseModulesDoNotStart) {
  Configure(Shell("SLOW", "cat >/dev/null", ", \"ready\": \"Run = LIVE\""));
  Process hub({kHub, "--config", path_});
  hub.WriteLine("quit");
  EXPECT_EQ(hub.Wait(), 0) << hub.ErrorText();
}

TEST_F(SupervisionTest, AClientThatDoesNotSayWhatItIsHoldsOnlyWhatIsSaidToIt) {
  const std::string socket = folder_ / "hub.sock";
  std::ofstream(path_) << "{\"listen\": [\"unix:" << socket << "\"]}";
  Process hub({kHub, "--config", path_});
  Ask(hub, "Clock");
  const auto mute = support::SocketClient::Unix(socket);
  mute->WriteLine("set#1 Name = MUTE");
  ASSERT_TRUE(mute->Expect("rep#1 Name = MUTE"));
  mute->WriteLine("rep Run = LIVE");
  ASSERT_TRUE(mute->Expect("inq#")) << "it is being asked";
  hub.WriteLine("to @MUTE set X = 1");
  EXPECT_NE(Ask(hub, "Clock"), "");
}

TEST_F(SupervisionTest, AStderrThatNobodyReadsHoldsNobodyUp) {
  const std::string fifo = folder_ / "stderr";
  mkfifo(fifo.c_str(), 0600);
  const int unread = open(fifo.c_str(), O_RDWR | O_CLOEXEC);
  fcntl(unread, F_SETPIPE_SZ, 4096);
  Configure("");
  Process hub({"/bin/sh", "-c", "exec '" + kHub + "' --config '" + path_ + "' 2>'" + fifo + "'"});
  for (int i = 0; i < 300; ++i) hub.WriteLine("to @NOBODY_" + std::to_string(i) + " nonsense");
  EXPECT_NE(Ask(hub, "Clock"), "");
  hub.WriteLine("set Run = EXIT");
  EXPECT_EQ(hub.Wait(), 0);
  close(unread);
}

/// X says under which configuration it was started, and does not exit before Release().
class ReloadWhileStoppingTest : public SupervisionTest {
 protected:
  ReloadWhileStoppingTest() { mkfifo(gate_.c_str(), 0600); }
  void ConfigureX(const std::string& version) {
    Configure(Shell("X", "echo started $V >&2; read a; read b; cat " + gate_,
                    ", \"stop_within_ms\": 20000, \"env\": {\"V\": \"" + version + "\"}"));
  }
  void Reload(Process& hub) {
    const std::string tag = "r" + std::to_string(++asked_);
    hub.WriteLine("set#" + tag + " Reload = NOW");
    ASSERT_TRUE(hub.Expect("rep#" + tag + " Reload = NOW")) << hub.ErrorText();
  }
  void Release() const { std::ofstream(gate_) << "go\n"; }

  std::string gate_ = folder_ / "gate";
};

TEST_F(ReloadWhileStoppingTest, TheLastConfigurationCounts) {
  ConfigureX("A");
  Process hub({kHub, "--config", path_});
  ASSERT_TRUE(hub.ExpectError("X INFO: started A")) << hub.ErrorText();
  ConfigureX("B");
  Reload(hub);
  EXPECT_EQ(Ask(hub, "Module.X.state"), "STOPPING");
  ConfigureX("A");
  Reload(hub);
  Release();
  std::string log;
  while (log.find("started") == log.rfind("started")) log = Ask(hub, "Module.X.log");
  EXPECT_EQ(log.find("started B"), std::string::npos) << log;
}

TEST_F(ReloadWhileStoppingTest, AModuleTakenOutAndPutBackIsStartedOnceItHasGone) {
  ConfigureX("A");
  Process hub({kHub, "--config", path_});
  ASSERT_TRUE(hub.ExpectError("X INFO: started A")) << hub.ErrorText();
  Configure("");
  Reload(hub);
  ConfigureX("B");
  Reload(hub);
  EXPECT_EQ(Ask(hub, "Module.X.state"), "STOPPING");
  Release();
  EXPECT_TRUE(hub.ExpectError("X INFO: started B")) << hub.ErrorText();
  EXPECT_EQ(Ask(hub, "Module.X.starts"), "2") << "no start while the old one ran";
}

TEST_F(SupervisionTest, AModuleTakenOutMayWriteUntilItHasGone) {
  Configure(Shell("X", "echo up >&2; read a; echo late >&2; read b"));
  Process hub({kHub, "--config", path_});
  ASSERT_TRUE(hub.ExpectError("X INFO: up")) << hub.ErrorText();
  Configure("");
  hub.WriteLine("set#reload Reload = NOW");
  ASSERT_TRUE(hub.Expect("rep#reload Reload = NOW")) << hub.ErrorText();
  EXPECT_TRUE(hub.ExpectError("X INFO: late")) << hub.ErrorText();
  EXPECT_EQ(Ask(hub, "Run"), "LIVE") << hub.ErrorText();
}

TEST_F(SupervisionTest, NobodyDefinesTheSlotsOfAModuleThatIsYetToBeConfigured) {
  Configure("");
  Process hub({kHub, "--config", path_});
  hub.WriteLine("def#def Module.NEW.state = x");
  EXPECT_TRUE(hub.Expect("rep#def Module.NEW.state.error = ACCESS")) << hub.Seen();
  Configure(Module("NEW"));
  hub.WriteLine("set#reload Reload = NOW");
  ASSERT_TRUE(hub.Expect("rep#reload Reload = NOW")) << hub.ErrorText();
  EXPECT_EQ(Ask(hub, "Module.NEW.starts"), "1");
}

TEST_F(SupervisionTest, ABrokerThatCannotBeJoinedAgainLeavesNoReloadUnanswered) {
  const std::string password = folder_ / "password";
  const auto configure = [this](const std::string& file) {
    std::ofstream(path_)
        << R"({"mqtt": {"broker": "tcp:127.0.0.1:1", "agent": "HERE", "user": "u", )"
        << R"("password_file": ")" << file << "\"}}";
  };
  std::ofstream(password) << "secret\n";
  chmod(password.c_str(), 0600);
  configure(password);
  Process hub({kHub, "--config", path_});
  ASSERT_EQ(Ask(hub, "Run"), "LIVE") << hub.ErrorText();
  unlink(password.c_str());
  configure(folder_ / "none");
  hub.WriteLine("set#reload Reload = NOW");
  const auto answer = hub.Expect("rep#reload Reload.error = BAD_VALUE");
  ASSERT_TRUE(answer) << hub.Seen() << hub.ErrorText();
  EXPECT_NE(answer->find("the broker of before cannot be joined again"), std::string::npos)
      << *answer;
}

TEST_F(SupervisionTest, ALimitOfStartingThatIsConfiguredAnewCounts) {
  const std::string socket = folder_ / "hub.sock";
  const auto configure = [&](const std::string& limit_ms) {
    std::ofstream(path_) << R"({"modules": [{"name": "MUTE", "command": "cat >/dev/null"}], )"
                         << R"("listen": ["unix:)" << socket << R"("], "start_limit_ms": )"
                         << limit_ms << "}";
  };
  configure("600000");
  Process hub({kHub, "--config", path_});
  const auto client = support::SocketClient::Unix(socket);
  client->WriteLine("inq#1 Run");
  ASSERT_TRUE(client->Expect("rep#1 Run = LIVE")) << hub.ErrorText();
  configure("100");
  hub.Signal(SIGHUP);  // the console waits for MUTE
  EXPECT_TRUE(hub.ExpectError("@MUTE has no slot Clock: it works, but by this machine's time"))
      << hub.ErrorText();
  EXPECT_TRUE(hub.ExpectError("\"dialect\": \"original\" in its configuration")) << hub.ErrorText();
}

TEST_F(SupervisionTest, AModuleIsTriedAgainWhileDescriptorsAreLacking) {
  if (support::kSanitized) GTEST_SKIP() << "the sanitizers need descriptors of their own";
  const std::string socket = folder_ / "hub.sock";
  std::ofstream(path_) << "{\"listen\": [\"unix:" << socket << "\"], \"modules\": ["
                       << Module("TEST",
                                 ", \"restart\": {\"when\": \"always\", \"first_ms\": 1, "
                                 "\"longest_ms\": 20, \"tries\": 10000}")
                       << "]}";
  Process hub({"/bin/sh", "-c", "ulimit -n 40; exec '" + kHub + "' --config '" + path_ + "'"});
  const std::string pid = Ask(hub, "Module.TEST.pid");
  std::vector<std::unique_ptr<support::SocketClient>> many;
  for (int i = 0; i < 40; ++i) many.push_back(support::SocketClient::Unix(socket));
  for (const auto& client : many) {  // answered or closed: all have been accepted
    client->WriteLine("inq#1 Run");
    static_cast<void>(client->Expect("rep#1 Run = LIVE"));
  }
  kill(std::stoi(pid), SIGKILL);
  EXPECT_TRUE(hub.ExpectError("': Too many open files")) << hub.ErrorText();
  many.clear();
  EXPECT_TRUE(hub.Expect("From @TEST rep Run = LIVE")) << hub.ErrorText();
}

TEST_F(SupervisionTest, TheServiceManagerIsTold) {
  const std::string socket_path = folder_ / "notify";
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  socket_path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const timeval patience{20, 0};
  setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  const auto hear = [fd] {
    char text[200];
    const ssize_t n = recv(fd, text, sizeof(text), 0);
    return n > 0 ? std::string(text, static_cast<std::size_t>(n)) : std::string();
  };
  Configure(Module("TEST"));
  Process hub({kHub, "--config", path_}, {.cwd = "", .env = {"NOTIFY_SOCKET=" + socket_path}});
  EXPECT_EQ(hear(), "READY=1");
  hub.WriteLine("set Reload = NOW");
  EXPECT_EQ(hear(), "RELOADING=1");
  EXPECT_EQ(hear(), "READY=1");
  hub.Terminate();
  EXPECT_EQ(hear(), "STOPPING=1");
  EXPECT_EQ(hub.Wait(), 0);
  close(fd);
}

}  // namespace
