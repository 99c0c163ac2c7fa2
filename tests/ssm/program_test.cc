// The real programs, over pipes and sockets, as a client of the original sees them.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "ssm/voice/wav_file.h"
#include "tests/support/process.h"

namespace {

using support::Process;
using support::SocketClient;
using support::TempDir;
using Lines = std::vector<std::string>;
using Clock = std::chrono::steady_clock;

long MsSince(Clock::time_point then) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - then).count();
}

/// A port nobody listens on at this moment.
int FreePort() {
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  bind(fd, reinterpret_cast<sockaddr*>(&address), size);
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  close(fd);
  return ntohs(address.sin_port);
}

class VoiceProgramTest : public testing::TestWithParam<const char*> {
 protected:
  std::vector<std::string> Command(std::vector<std::string> more = {}) {
    std::vector<std::string> argv{std::string(GALATEA_BIN_DIR) + "/" + GetParam(), "--sink",
                                  "null"};
    argv.insert(argv.end(), more.begin(), more.end());
    return argv;
  }
  Lines RunBatch(const std::string& input, std::vector<std::string> more = {}) {
    Process program(Command(std::move(more)));
    program.Write(input);
    program.CloseInput();
    Lines lines = program.ReadAll();
    exit_code_ = program.Wait().value_or(-1);
    errors_ = program.ErrorText();
    return lines;
  }
  int exit_code_ = -1;
  std::string errors_;
};
INSTANTIATE_TEST_SUITE_P(Programs, VoiceProgramTest, testing::Values("ssm", "ssm_stub"),
                         [](const auto& one) { return std::string(one.param); });

TEST_P(VoiceProgramTest, AClientOfTheOriginalGetsWhatItWaitsFor) {
  Process program(Command());
  ASSERT_TRUE(program.Expect("rep Run = LIVE"));
  program.WriteLine("set Speaker = male01");
  ASSERT_TRUE(program.Expect("rep Speaker = male01"));
  program.WriteLine("set Text = Hello, this takes a second or so.");
  ASSERT_TRUE(program.Expect("rep Speak.stat = READY"));
  program.WriteLine("set Speak = NOW");
  ASSERT_TRUE(program.Expect("rep Speak.stat = SPEAKING"));
  const auto began = Clock::now();
  ASSERT_TRUE(program.Expect("rep Speak.stat = IDLE"));
  EXPECT_GT(MsSince(began), 1000) << "a client that talks back and forth lives on the real clock";
  program.WriteLine("set Run = EXIT");
  EXPECT_TRUE(program.Expect("rep Run = EXIT"));
  EXPECT_EQ(program.Wait(), 0);
  EXPECT_EQ(program.ErrorText(), "");
}

TEST_P(VoiceProgramTest, OverASocketAllMessagesEndAsTheOriginals) {
  const int port = FreePort();
  Process program(Command({"-p", std::to_string(port)}));
  const auto client = SocketClient::Tcp(static_cast<unsigned short>(port));
  EXPECT_EQ(client->ReadLine(), "rep Run = LIVE./");
  client->Write("set Speaker = female01./\r\nset Text =\nHello there../\n");  // over two lines
  EXPECT_EQ(client->ReadLine(), "rep Speaker = female01./");
  EXPECT_EQ(client->ReadLine(), "rep Speak.stat = PROCESSING./");
  EXPECT_EQ(client->ReadLine(), "rep Text.text = Hello there../");
  ASSERT_TRUE(client->Expect("rep Speak.stat = READY./"));
  client->Write("set Speak = NOW./\n");
  EXPECT_EQ(client->ReadLine(), "rep Speak.stat = SPEAKING./");
  ASSERT_TRUE(client->Expect("rep Speak.utt = "));
  EXPECT_EQ(client->ReadLine(), "rep Speak.stat = IDLE./");
  const auto second = SocketClient::Tcp(static_cast<unsigned short>(port));
  EXPECT_FALSE(second->ReadLine()) << "one client at a time";
  EXPECT_TRUE(second->AtEnd());
  client->Write("set Run = CLOSE./\n");  // drops the client, keeps the process
  EXPECT_FALSE(client->ReadLine());
  const auto third = SocketClient::Tcp(static_cast<unsigned short>(port));
  EXPECT_EQ(third->ReadLine(), "rep Run = LIVE./");
}

TEST_P(VoiceProgramTest, StopIsQuick) {
  Process program(Command());
  program.WriteLine("set Text = This is a rather long sentence that goes on and on and on.");
  ASSERT_TRUE(program.Expect("rep Speak.stat = READY"));
  for (int i = 0; i < 3; ++i) {
    program.WriteLine("set Speak = NOW");
    program.WriteLine("set Wait = 300");
    program.WriteLine("set#s Speak = STOP");
    ASSERT_TRUE(program.Expect("rep Speak.stat = SPEAKING"));
    const auto len = program.Expect("rep Speak.len = ");
    ASSERT_TRUE(len && program.Expect("rep#s Speak = STOP"));
    const long spoken = std::stol(len->substr(16));
    EXPECT_GE(spoken, 295);
    EXPECT_LE(spoken, 400) << "50 ms and what a busy machine adds";
  }
}

TEST_P(VoiceProgramTest, NamedPipesInLinesAreRefusedAndItGoesOn) {
  const TempDir folder;
  for (const char* name : {"pipe", "a.info", "b.wav.lab"}) {
    ASSERT_EQ(mkfifo((folder / name).c_str(), 0600), 0);
  }
  Process program(Command(), {.cwd = folder.path(), .env = {}});
  program.WriteLine("set Text = hello");
  program.WriteLine("set#ready SaveWAV = c");
  ASSERT_TRUE(program.Expect("rep#ready SaveWAV = c"));
  ASSERT_EQ(unlink((folder / "c.info").c_str()), 0);
  ASSERT_EQ(mkfifo((folder / "c.info").c_str(), 0600), 0);
  const bool engines = GetParam() == std::string("ssm");
  const Lines lines{"save#1 mine << pipe",    "do#1 pipe",
                    "set#1 Text < pipe",      "set#1 SaveWAV = pipe",
                    "set#1 SaveRAW = pipe",   "set#1 Save = pipe",
                    "set#1 SaveWAV = a",      "set#1 Save = b.wav",
                    "set#1 SavePros = pipe",  "set#1 Log = pipe",
                    "set#1 Err = pipe",       "set#1 Record = pipe",
                    "set#1 LoadWAV = pipe",   "set#1 LoadRAW = pipe",
                    "set#1 LoadWAV = c",      "set#1 SpeechFile = pipe",
                    "set#1 LoadPros = pipe",  "set#1 ProsFile = pipe",
                    "set#1 ParsedText = pipe"};
  for (const std::string& line : lines) {
    program.WriteLine(line);
    const auto answer = program.Expect("rep#1 ");
    ASSERT_TRUE(answer) << line;
    const bool none = !engines && line.starts_with("set#1 Err");  // the stub has no such file
    EXPECT_NE(answer->find(none ? ".error = UNAVAILABLE" : "' is not a regular file"),
              std::string::npos)
        << line << "\n"
        << *answer;
  }
  program.WriteLine("set#2 Text = hello again");
  EXPECT_TRUE(program.Expect("rep#2 Text = hello again"));
}

TEST_P(VoiceProgramTest, ABatchPipedInIsDoneAtOnceOnTheVirtualClock) {
  // An hour's pause: on the real clock the batch would outlast any patience.
  const Lines lines = RunBatch(
      "set Text = Hello, my name is Galatea and I am here.\nset Speak = NOW\nset Wait = IDLE\n"
      "set Speak = +3600000\nset Wait = IDLE\ninq Clock\n");
  EXPECT_EQ(exit_code_, 0);
  ASSERT_FALSE(lines.empty());
  EXPECT_GT(std::stod(lines.back().substr(12)), 3600000 + 2 * 1500);
}

TEST_P(VoiceProgramTest, ALongTextIsPreparedWithoutHoldingUpOthers) {
  std::string text;
  while (text.size() < 2500) text += "This sentence is one of many and all are the same. ";
  Process program(Command({"--clock", "real"}));
  program.WriteLine("set Text = " + text);
  program.WriteLine("inq#alive Run");
  program.WriteLine("set Speak = NOW");
  ASSERT_TRUE(program.Expect("rep#alive Run = LIVE"));
  ASSERT_TRUE(program.Expect("rep Speak.stat = SPEAKING"));
  program.WriteLine("set Speak = STOP");
  ASSERT_TRUE(program.Expect("rep Speak.stat = IDLE"));
}

TEST_P(VoiceProgramTest, EndOfInputWaitsForTheEndOfSpeech) {
  const Lines lines = RunBatch("set Text = Hello.\nset Speak = NOW\n", {"--clock", "real"});
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.back(), "rep Speak.stat = IDLE");
  EXPECT_EQ(exit_code_, 0);
}

TEST_P(VoiceProgramTest, ErrorsGoToStderrAndTheExitCode) {
  RunBatch("set Speaker = nobody\nset Alpha = 0.4\nfoo\n", {"--strict"});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_NE(errors_.find("unknown speaker 'nobody'"), std::string::npos);
  RunBatch("set Text = Hello.\n", {"--strict"});
  EXPECT_EQ(exit_code_, 0);
}

TEST_P(VoiceProgramTest, AHubsClockMovesItExactly) {
  Process program(Command());
  program.WriteLine("set#1 Clock.mode = HUB");
  program.WriteLine("set Text = Hello.");
  ASSERT_TRUE(program.Expect("READY"));
  program.WriteLine("inq Clock");
  const double now = std::stod(program.Expect("rep Clock = ")->substr(12));
  program.WriteLine("set Speak = @" + std::to_string(static_cast<long>(now) + 1000));
  program.WriteLine("set#2 Clock = " + std::to_string(static_cast<long>(now) + 999));
  const auto before = program.Expect("#2 Clock = ");
  ASSERT_TRUE(before);
  EXPECT_NE(before->find(" " + std::to_string(static_cast<long>(now) + 1000) + " "),
            std::string::npos)
      << *before;
  EXPECT_EQ(program.Seen().find("SPEAKING"), std::string::npos);
  program.WriteLine("set#3 Clock = " + std::to_string(static_cast<long>(now) + 60000));
  ASSERT_TRUE(program.Expect("SPEAKING"));
  ASSERT_TRUE(program.Expect("IDLE"));
  EXPECT_NE(program.Expect("#3 Clock = ")->find(" - "), std::string::npos);
}

TEST_P(VoiceProgramTest, VersionsArePrinted) {
  Process program(Command({"-v"}));
  const Lines lines = program.ReadAll();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[1], "Protocol Ver. 1.0");
  EXPECT_EQ(program.Wait(), 0);
}

class SsmProgramTest : public testing::Test {
 protected:
  const std::string ssm_ = std::string(GALATEA_BIN_DIR) + "/ssm";
  const TempDir dir_;
};

TEST_F(SsmProgramTest, TheFileSinkHoldsTheSpeech) {
  Process program({ssm_, "--sink", "file:" + dir_ / "out.wav"});
  program.Write("set Text = Hello.\nset Speak = NOW\nset Wait = IDLE\nset Speak = NOW\n");
  program.CloseInput();
  const auto dur = program.Expect("rep Text.dur = ");
  ASSERT_TRUE(dur);
  EXPECT_EQ(program.Wait(), 0);
  const auto samples = ssm::ReadWav(dir_ / "out.wav");
  ASSERT_TRUE(samples);
  EXPECT_EQ(samples->size(), 2 * 16 * std::stoul(dur->substr(15)));
}

// Whatever this machine has: ALSA without a configuration, on which PortAudio fails an assertion,
// and ALSA's "null", which takes an hour of sound in a second.
TEST_F(SsmProgramTest, WithoutASoundDeviceAutoSpeaksSilentlyAndSaysSoInOneLine) {
  for (const char* configuration :
       {"\n", "pcm.!default { type null }\nctl.!default { type null }\n"}) {
    std::ofstream(dir_ / "asound.conf") << configuration;
    Process::Options options;
    options.env = {"ALSA_CONFIG_PATH=" + dir_ / "asound.conf"};
    Process program({ssm_, "--clock", "real"}, options);
    program.Write("set Text = Hi.\nset Speak = NOW\ninq Sink\n");
    program.CloseInput();
    EXPECT_TRUE(program.Expect("rep Sink = null"));
    EXPECT_TRUE(program.Expect("rep Speak.stat = IDLE"));
    EXPECT_EQ(program.Wait(), 0);
    const std::string errors = program.ErrorText();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    EXPECT_NE(errors.find("speaking silently"), std::string::npos) << errors;
  }
}

TEST_F(SsmProgramTest, WhatCannotBeHadEndsItWithOneSentence) {
  const std::vector<std::vector<std::string>> bad = {{"--sink", "file:/nowhere/x.wav"},
                                                     {"--sink", "loud"},
                                                     {"--sink", "portaudio:no such device"},
                                                     {"-C", "/nowhere/ssm.conf"},
                                                     {"--clock", "virtual", "--sink", "portaudio"}};
  for (const auto& arguments : bad) {
    std::vector<std::string> argv{ssm_};
    argv.insert(argv.end(), arguments.begin(), arguments.end());
    Process program(argv);
    program.CloseInput();
    EXPECT_EQ(program.Wait(), 1) << arguments[1];
    const std::string errors = program.ErrorText();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  }
}

TEST_F(SsmProgramTest, TheOriginalsConfigurationNamesItsSpeakers) {
  std::ofstream(dir_ / "ssm.conf") << "# speakers\nCHASEN: /usr/bin/chasen\nAUTO-PLAY: NO\n"
                                      "AUTO-PLAY-DELAY: 250\nSPEAKER-ID: hanako\nGENDER: female\n"
                                      "DUR-TREE-FILE: /x\nSPEAKER-ID: taro\nGENDER: male\n";
  Process program({ssm_, "--sink", "null", "-C", dir_ / "ssm.conf"});
  program.Write("inq SpeakerSet\ninq Speaker\ninq AutoPlayDelay\nset Speaker = taro\n");
  program.CloseInput();
  EXPECT_EQ(program.ReadAll(),
            (Lines{"rep Run = LIVE", "rep SpeakerSet = slt rms awb kal16 hanako taro",
                   "rep Speaker = hanako", "rep AutoPlayDelay = \"250\"", "rep Speaker = taro"}));
  EXPECT_NE(program.ErrorText().find("CHASEN"), std::string::npos);
}

TEST_F(SsmProgramTest, ErrorTextsCanGoToAFileAndBack) {
  Process program({ssm_, "--sink", "null"});
  program.Write("set Err = " + dir_ / "err.txt" +
                "\nset Alpha = 1\nset Err = CONSOLE\nset Foo = 1\n");
  program.CloseInput();
  EXPECT_EQ(program.Wait(), 0);
  std::ifstream file(dir_ / "err.txt");
  std::string line, more;
  std::getline(file, line);
  EXPECT_NE(line.find("Alpha"), std::string::npos);
  EXPECT_FALSE(std::getline(file, more));
  EXPECT_NE(program.ErrorText().find("Foo"), std::string::npos);
}

TEST(SsmNoticeTest, ThatNothingIsHeardIsSaidByWhatRunsAndNotByWhatOnlyTellsItsSlots) {
  const std::string ssm = std::string(GALATEA_BIN_DIR) + "/ssm";
  const auto errors = [&ssm](std::vector<std::string> argv) {
    argv.insert(argv.begin(), ssm);
    Process program(argv);
    program.CloseInput();
    program.ReadAll();
    EXPECT_EQ(program.Wait().value_or(-1), 0);
    return program.ErrorText();
  };
  EXPECT_EQ(errors({"--clock", "virtual", "--slots-markdown"}), "");
  EXPECT_NE(errors({"--clock", "virtual"}).find("nothing is heard"), std::string::npos);
}

}  // namespace
