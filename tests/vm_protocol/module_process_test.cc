// The runtime every module shares, in a real process: stdio, sockets, clocks, the end.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/process.h"

namespace {

using support::Process;
using support::SocketClient;
using Strings = std::vector<std::string>;

const std::string kModule = GALATEA_BIN_DIR "/test_module";

TEST(ModuleProcessTest, ABatchPipedInIsDoneAndEndsWithZero) {
  Process module({kModule});
  module.Write("set X = 5\nset#1 Work = 10000\n");
  module.CloseInput();
  EXPECT_EQ(module.ReadAll(), (Strings{"rep Run = LIVE", "rep X = 5", "tell worked until 10000",
                                       "rep#1 Work = done"}));
  EXPECT_EQ(module.Wait(), 0) << "ten seconds of work on the virtual clock are no time at all";
}

TEST(ModuleProcessTest, ARegularFileAsInputIsABatchToo) {
  Process module({"/bin/sh", "-c",
                  "printf 'set X = 5\\n' > batch.$$; exec 3<batch.$$; rm batch.$$; exec '" +
                      kModule + "' <&3"},
                 Process::Options{.cwd = testing::TempDir(), .env = {}});
  EXPECT_EQ(module.ReadAll(), (Strings{"rep Run = LIVE", "rep X = 5"}));
  EXPECT_EQ(module.Wait(), 0);
}

TEST(ModuleProcessTest, WaitHoldsTheLinesThatFollowOnTheVirtualClockExactly) {
  Process module({kModule, "--clock", "virtual"});
  module.Write("set Work = 300\nset Wait = 100\ninq Clock\nset Wait = IDLE\ninq Clock\n");
  module.CloseInput();
  EXPECT_EQ(module.ReadAll(), (Strings{"rep Run = LIVE", "rep Clock = 100", "tell worked until 300",
                                       "rep Clock = 300"}));
  EXPECT_EQ(module.Wait(), 0);
}

TEST(ModuleProcessTest, UnderTheHubsClockTimeMovesOnlyBySettingIt) {
  Process module({kModule, "--clock", "virtual"});
  module.Write("set#a Clock.mode = HUB\nset Work = 40\nset#b Clock = 25\nset#c Clock = 60\n");
  module.CloseInput();
  EXPECT_EQ(module.ReadAll(),
            (Strings{"rep Run = LIVE", "rep#a Clock.mode = HUB", "rep#b Clock = 25 40 BUSY",
                     "tell worked until 40", "rep#c Clock = 60 - IDLE"}));
  EXPECT_EQ(module.Wait(), 0);
}

TEST(ModuleProcessTest, StrictMakesErrorsCount) {
  for (const bool strict : {false, true}) {
    Process module(strict ? Strings{kModule, "--strict"} : Strings{kModule});
    module.Write("set X = nan\n");
    module.CloseInput();
    EXPECT_EQ(module.Wait(), strict ? 1 : 0);
    EXPECT_NE(module.ErrorText().find(
                  "test_module: error: BAD_VALUE column 1: found 'nan', expected <number>"),
              std::string::npos)
        << module.ErrorText();
  }
}

TEST(ModuleProcessTest, AMegabyteWithoutNewlineAndGarbageAreReportedOnceAndTheRestGoesOn) {
  Process module({kModule});
  module.Write(std::string(1 << 20, 'x') + "\n\xff\xfe\nset X = 3\n");
  module.CloseInput();
  EXPECT_TRUE(module.Expect("rep X = 3"));
  EXPECT_EQ(module.Wait(), 0);
  const std::string errors = module.ErrorText();
  EXPECT_EQ(errors.find("TOO_LONG"), errors.rfind("TOO_LONG"));
  EXPECT_NE(errors.find("BAD_UTF8"), std::string::npos);
}

TEST(ModuleProcessTest, RunExitReportsAndEnds) {
  Process module({kModule});
  module.WriteLine("set Run = EXIT");
  EXPECT_TRUE(module.Expect("rep Run = EXIT"));
  EXPECT_EQ(module.Wait(), 0);
}

TEST(ModuleProcessTest, TerminationEndsItInOrder) {
  Process module({kModule});
  EXPECT_TRUE(module.Expect("rep Run = LIVE"));
  module.Terminate();
  EXPECT_EQ(module.Wait(), 0);
}

TEST(ModuleProcessTest, ManyClientsListenOverASocketAndAnswersGoToWhoAsked) {
  const support::TempDir folder;
  const std::string path = folder / "s";
  Process module({kModule, "--listen", "unix:" + path});
  const auto a = SocketClient::Unix(path);
  const auto b = SocketClient::Unix(path);
  EXPECT_TRUE(a->Expect("rep Run = LIVE"));
  EXPECT_TRUE(b->Expect("rep Run = LIVE"));
  a->WriteLine("inq#1 X");
  EXPECT_EQ(a->ReadLine(), "rep#1 X = 0");
  a->WriteLine("set X = 9");
  EXPECT_EQ(b->ReadLine(), "rep X = 9") << "changes go to all, the answer before went to one";
}

TEST(ModuleProcessTest, TheOriginalsSocketModeEndsMessagesInDotSlashAndTakesOneClient) {
  Process module({kModule, "-p", "0"});  // ports up to 1024 mean the default, as in the original
  ASSERT_TRUE(module.ExpectError("listening on tcp:127.0.0.1:10600")) << module.ErrorText();
  const auto client = SocketClient::Tcp(10600);
  EXPECT_EQ(client->ReadLine(), "rep Run = LIVE./");
  client->Write("set X =\n4./\n");
  EXPECT_EQ(client->ReadLine(), "rep X = 4./");
  const auto second = SocketClient::Tcp(10600);
  EXPECT_EQ(second->ReadLine(), std::nullopt);
  EXPECT_TRUE(second->AtEnd());
  client->Write("set Run = CLOSE./\n");
  EXPECT_EQ(client->ReadLine(), std::nullopt);
  const auto third = SocketClient::Tcp(10600);
  EXPECT_EQ(third->ReadLine(), "rep Run = LIVE./");
}

TEST(ModuleProcessTest, EndOfInputEndsItEvenIfNoTimerTellsTheEndOfItsWork) {
  Process module({kModule, "--clock", "real"});
  module.Write("set#1 Settle = 100\n");
  EXPECT_TRUE(module.Expect("rep#1"));
  module.CloseInput();
  EXPECT_EQ(module.Wait(), 0);
}

TEST(ModuleProcessTest, ExitComesAfterWhatWasSaidBeforeIt) {
  for (const auto* clock : {"real", "virtual"}) {
    Process module({kModule, "--clock", clock});
    module.Write("set#1 Work = 100\nset#2 Run = EXIT\n");
    const Strings said = module.ReadAll();
    ASSERT_EQ(said.size(), 5u) << module.Seen();
    EXPECT_EQ(said[1].substr(0, 12), "tell worked ");
    EXPECT_EQ((Strings{said[2], said[3], said[4]}),
              (Strings{"rep#1 Work = done", "rep Run = EXIT", "rep#2 Run = EXIT"}));
    EXPECT_EQ(module.Wait(), 0);
  }
}

TEST(ModuleProcessTest, ASecondExitAndASignalEndItAtOnce) {
  for (const bool signal : {false, true}) {
    Process module({kModule, "--clock", "real"});
    module.Write("set Work = 80000000\nset Run = EXIT\ninq#1 Clock.busy\n");
    EXPECT_TRUE(module.Expect("rep#1 Clock.busy = BUSY"));
    if (signal) {
      module.Terminate();
    } else {
      module.WriteLine("set Run = EXIT");
    }
    EXPECT_EQ(module.Wait(), 0);
  }
}

TEST(ModuleProcessTest, AClientThatHalfClosesStillGetsItsAnswers) {
  const support::TempDir folder;
  const std::string path = folder / "s";
  Process module({kModule, "--listen", "unix:" + path});
  for (int i = 0; i < 20; ++i) {
    const auto client = SocketClient::Unix(path);
    client->Write("set#1 Work = 30\ninq#2 X");
    client->CloseInput();
    const Strings said = client->ReadAll();
    ASSERT_EQ(said.size(), 4u);
    EXPECT_EQ(said[1], "rep#2 X = 0") << "a last line without its newline counts";
    EXPECT_EQ(said[3], "rep#1 Work = done");
    EXPECT_TRUE(client->AtEnd());
  }
}

TEST(ModuleProcessTest, ASignalEndsItWhileItConnects) {
  const support::TempDir folder;
  const std::string path = folder / "s";
  std::ofstream(folder / "token") << "0123456789abcdef\n";
  ASSERT_EQ(chmod((folder / "token").c_str(), 0600), 0);
  Process silent(
      {kModule, "--listen", "unix:" + path});  // asks for no token, however long it waits
  const auto there = SocketClient::Unix(path);
  silent.Signal(SIGSTOP);
  Process module({kModule, "--connect", "unix:" + path, "--token-file", folder / "token"});
  const auto ready = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  const std::string status = "/proc/" + std::to_string(module.pid()) + "/wchan";
  const auto waits = [&] {
    std::string what;
    std::getline(std::ifstream(status) >> std::ws, what);
    return what.find("epoll") != std::string::npos;
  };
  while (!waits() && std::chrono::steady_clock::now() < ready) std::this_thread::yield();
  module.Terminate();
  EXPECT_EQ(module.Wait(std::chrono::seconds(5)), 0) << "before its 10 s have run out";
  silent.Signal(SIGCONT);
}

TEST(ModuleProcessTest, AClientOfTheOriginalsEncodingIsAnsweredInItWithoutBeingAsked) {
  Process module({kModule});
  module.Write("def Text = \xa4\xa2\ninq Text\n");
  module.CloseInput();
  EXPECT_TRUE(module.Expect("rep Text = \xa4\xa2"));
  EXPECT_EQ(module.Wait(), 0);
}

TEST(ModuleProcessTest, SpeaksTheOriginalsEncodings) {
  Process module({kModule, "--encoding", "euc-jp"});
  module.Write("def Text = \xa4\xa2\ninq Text\n");
  module.CloseInput();
  EXPECT_TRUE(module.Expect("rep Text = \xa4\xa2"));
  EXPECT_EQ(module.Wait(), 0);
}

TEST(ModuleProcessTest, AWorldThatRefusesIsOneSentenceAndANonzeroEnd) {
  Process module({kModule, "--connect", "unix:/nonexistent/hub"});
  EXPECT_EQ(module.Wait(), 1);
  EXPECT_NE(module.ErrorText().find("test_module: cannot connect to unix:/nonexistent/hub"),
            std::string::npos)
      << module.ErrorText();
}

TEST(ModuleProcessTest, ANamedPipeInALineIsRefusedAndTheRestGoesOn) {
  const support::TempDir folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  Process module({kModule});
  const std::string why = "'" + pipe + "' is not a regular file";
  for (const std::string line : {"set#1 X < ", "do#1 ", "save#1 mine << "}) {
    module.WriteLine(line + pipe);
    const auto answer = module.Expect("rep#1 ");
    ASSERT_TRUE(answer) << line;
    EXPECT_NE(answer->find(why), std::string::npos) << *answer;
  }
  module.WriteLine("set X = 5");
  EXPECT_TRUE(module.Expect("rep X = 5"));
}

TEST(ModuleProcessTest, HelpAndVersionAreThere) {
  Process help({kModule, "--help"});
  EXPECT_TRUE(help.Expect("--listen"));
  EXPECT_EQ(help.Wait(), 0);
  Process version({kModule, "--version"});
  EXPECT_EQ(version.ReadLine(), "test_module (Galatea) " GALATEA_VERSION);
}

}  // namespace
