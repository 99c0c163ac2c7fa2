// The program, with a stand-in for the model's endpoint, alone and behind the hub.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <string>
#include <vector>

#include "tests/support/certificates.h"
#include "tests/support/process.h"

namespace {

using Lines = std::vector<std::string>;
using support::Process;

class ChatProgramTest : public testing::Test {
 protected:
  ChatProgramTest() : server_({"python3", GALATEA_SOURCE_DIR "/tests/chat/stub_model.py"}) {
    port_ = server_.ReadLine().value_or("");
    key_ = folder_ / "key";
    std::ofstream(key_) << "sk-test\n";
    ::chmod(key_.c_str(), 0600);
  }
  std::string Url() const { return "http://127.0.0.1:" + port_; }
  Lines Options(const std::string& model) const {
    return {GALATEA_BIN_DIR "/chat", "--model-url", Url(), "--model", model, "--key-file", key_};
  }
  /// Answers one line with that model, without a hub; "" for none within the time limit.
  std::string Ask(const std::string& model, const std::string& more = "") {
    Process chat(Options(model));
    chat.WriteLine("set Apology = OFF");
    if (!more.empty()) chat.WriteLine(more);
    chat.WriteLine("set#1 Input.text = Hello");
    const std::string answer = chat.Expect("rep#1 ").value_or("");
    chat.CloseInput();
    EXPECT_EQ(chat.Wait(), 0) << chat.ErrorText();
    errors_ = chat.ErrorText();
    EXPECT_FALSE((chat.Seen() + errors_).contains("sk-test")) << "the key is never shown";
    return answer;
  }

  support::TempDir folder_;
  Process server_;
  std::string port_, key_, errors_;
};

TEST_F(ChatProgramTest, AModelAnswers) {
  EXPECT_EQ(Ask("echo"), "rep#1 Input.text = You said: Hello. That is all I know.");
  EXPECT_EQ(server_.Expect("POST"), "POST /v1/chat/completions Bearer sk-test echo | Hello");
  EXPECT_EQ(Ask("slow"), "rep#1 Input.text = You said: Hello. That is all I know.");
  EXPECT_EQ(Ask("whole"), "rep#1 Input.text = You said: Hello. That is all I know.");
}

TEST_F(ChatProgramTest, EveryFaultIsOneErrorAndTheProgramGoesOn) {
  struct Case {
    const char* model;
    const char* error;
  };
  for (const Case& one :
       {Case{"401", "ACCESS "}, Case{"500", "UNAVAILABLE "}, Case{"429", "BUSY "},
        Case{"404", "UNAVAILABLE "}, Case{"307", "UNAVAILABLE "}, Case{"stall", "TIMEOUT "},
        Case{"break", "UNAVAILABLE "}, Case{"nonsense", "SYNTAX "}, Case{"giant", "TOO_LONG "},
        Case{"big", "TOO_LONG "}, Case{"close", "UNAVAILABLE "}}) {
    const std::string answer = Ask(one.model, "set Model.stall = 1");
    EXPECT_TRUE(answer.starts_with("rep#1 Input.text.error = " + std::string(one.error)))
        << one.model << ": " << answer;
    EXPECT_EQ(std::count(errors_.begin(), errors_.end(), '\n'), 1) << one.model << ": " << errors_;
  }
}

TEST_F(ChatProgramTest, RedirectionsAreNotFollowed) {
  Ask("307");
  EXPECT_TRUE(server_.Expect("/v1/chat/completions"));
  server_.Terminate();
  for (const std::string& line : server_.ReadAll())
    EXPECT_FALSE(line.contains("elsewhere")) << line;
}

TEST_F(ChatProgramTest, AnEndpointThatIsNotThereIsAnError) {
  server_.Terminate();
  server_.Wait();
  EXPECT_TRUE(Ask("echo").starts_with("rep#1 Input.text.error = UNAVAILABLE http://127.0.0.1"));
}

TEST_F(ChatProgramTest, CertificatesAreChecked) {
  const support::Certificates certificates(folder_ / "");
  certificates.Sign("stub");
  Process server({"python3", GALATEA_SOURCE_DIR "/tests/chat/stub_model.py", "--tls",
                  certificates.Certificate("stub"), certificates.Key("stub")});
  const std::string url = "https://127.0.0.1:" + server.ReadLine().value_or("");
  const auto ask = [&](Lines options) {
    options.insert(options.begin(),
                   {GALATEA_BIN_DIR "/chat", "--model-url", url, "--model", "echo"});
    Process chat(options);
    chat.WriteLine("set#1 Input.text = Hello");
    return chat.Expect("rep#1 ").value_or("");
  };
  EXPECT_TRUE(ask({}).contains("UNAVAILABLE")) << "nobody we trust has signed it";
  EXPECT_TRUE(ask({"--ca-file", certificates.Certificate("ca")}).contains("You said"));
}

TEST_F(ChatProgramTest, SayStopEndsTheRequestAtOnce) {
  Process chat(Options("long"));
  chat.WriteLine("set#1 Input.text = Hello");
  EXPECT_TRUE(chat.Expect("number 3"));
  chat.WriteLine("set Say = STOP");
  EXPECT_TRUE(chat.Expect("rep#1 Input.text.error = STOPPED"));
  EXPECT_TRUE(server_.Expect("CLOSED"));
}

TEST_F(ChatProgramTest, WhatIsWrongAtTheStartIsOneSentence) {
  const auto refused = [](const Lines& options) {
    Lines all{GALATEA_BIN_DIR "/chat"};
    all.insert(all.end(), options.begin(), options.end());
    Process chat(all);
    chat.CloseInput();
    EXPECT_EQ(chat.Wait(), 1);
    return chat.ErrorText();
  };
  const std::string open_key = folder_ / "open";
  std::ofstream(open_key) << "sk-test\n";
  EXPECT_TRUE(refused({"--key-file", open_key}).contains("open to others"));
  EXPECT_TRUE(refused({"--model-url", "localhost"}).contains("no address of a model"));
  EXPECT_TRUE(refused({"--allow-set", "Mask"}).contains("expected @MODULE SLOT"));
  EXPECT_TRUE(refused({"--tags", key_}).contains(key_ + ":1: "));
}

/// Behind the hub, on the virtual clock, with the voice's and the ear's stand-ins.
class ChatHubTest : public ChatProgramTest {
 protected:
  Lines Run(const std::string& chat, const Lines& script, const std::string& more = "") {
    std::ofstream config(folder_ / "c.json");
    config << R"({"clock": "virtual", "modules": [{"name": "SSM", "command": [")" GALATEA_BIN_DIR
              R"(/ssm_stub"]}, {"name": "SRM", "command": [")" GALATEA_BIN_DIR
              R"(/srm_stub"]}, {"name": "CHAT", "command": [")" GALATEA_BIN_DIR R"(/chat")"
           << chat << R"(], "after": ["SRM"]}]})" << more;
    config.close();
    Process hub({GALATEA_BIN_DIR "/agent_manager", "--config", folder_ / "c.json", "--log",
                 folder_ / "log"});
    hub.WriteLine("set Wait = 1");  // until the ear listens
    for (const std::string& line : script) hub.WriteLine(line);
    hub.CloseInput();
    const Lines said = hub.ReadAll(std::chrono::seconds(60));
    EXPECT_EQ(hub.Wait(), 0) << hub.ErrorText();
    return said;
  }
  /// The log's lines with `part`: milliseconds since the hub began, and the line.
  Lines Log(const std::string& part) const {
    Lines found;
    std::ifstream log(folder_ / "log");
    for (std::string line; std::getline(log, line);) {
      if (!line.contains(part)) continue;
      found.push_back(line.substr(0, line.find('\t')) + line.substr(line.rfind('\t')));
    }
    return found;
  }
  static long At(const Lines& lines) { return lines.empty() ? -1 : std::stol(lines.front()); }
};

TEST_F(ChatHubTest, RulesAnswerWhatTheEarHearsToTheMillisecond) {
  Run("", {"to @SRM set Input.text = What is your name?", "set Wait = IDLE"});
  const long heard = At(Log("rep Result = "));
  ASSERT_GE(heard, 0);
  EXPECT_EQ(At(Log("SSM rep Speak.stat = SPEAKING")) - heard, 60) << "the hub's margin of a start";
  const Lines spoken = Log("to @AM-MCL set#");
  ASSERT_EQ(spoken.size(), 2u);
  EXPECT_TRUE(spoken[0].contains("Speak = I am Galatea, a talking agent with a face."))
      << spoken[0];
  EXPECT_EQ(Log("to @SSM set Text.next = And who are you?").size(), 1u);
  const Lines idle = Log("SSM rep Speak.stat = IDLE");
  const Lines speaking = Log("SSM rep Speak.stat = SPEAKING");
  ASSERT_EQ(speaking.size(), 2u);
  EXPECT_EQ(std::stol(speaking[1]) - std::stol(idle[0]), 60) << "nothing is prepared between them";
}

TEST_F(ChatHubTest, WhoSpeaksIsListenedToAndTheHistoryKeepsWhatWasHeard) {
  Run("",
      {"to @SRM set Input.wordtime = 100", "to @CHAT set Say = One two three four five six seven.",
       "set Wait = 1060", "to @SRM set Input.text = What time is it", "set Wait = 600",
       "to @CHAT inq#h History", "set Wait = IDLE"});
  const long speech = At(Log("SRM rep Listen.stat = SPEECH"));
  EXPECT_EQ(At(Log("to @AM-MCL set Speak = STOP")), speech);
  const Lines idle = Log("SSM rep Speak.stat = IDLE");
  EXPECT_LE(At(idle) - speech, 0);
  const Lines history = Log("rep#h History");
  ASSERT_FALSE(history.empty());
  EXPECT_TRUE(history[0].contains(R"({"content":"One two)")) << history[0];
  EXPECT_FALSE(history[0].contains("seven")) << history[0];
}

TEST_F(ChatHubTest, AModelAnswersOnTheVirtualClock) {
  const std::string options = R"(, "--model-url", ")" + Url() + R"(", "--model", "echo")";
  Run(options, {"to @SRM set Input.text = Good morning.", "set Wait = IDLE"});
  const long heard = At(Log("rep Result = "));
  EXPECT_EQ(At(Log("SSM rep Speak.stat = SPEAKING")) - heard, 60);
  EXPECT_EQ(Log("CHAT rep Reply = You said: Good morning. That is all I know.").size(), 1u);
}

TEST_F(ChatHubTest, TheModelSetsASlotThatIsAllowed) {
  const auto options = [this](const std::string& slot) {
    return R"(, "--allow-set", "@SSM Rate", "--model-url", ")" + Url() +
           R"(", "--model", "tool @SSM )" + slot + R"( 1.5")";
  };
  Run(options("Rate"), {"to @SRM set Input.text = Faster!", "set Wait = IDLE"});
  EXPECT_EQ(Log("CHAT rep Reply = It says: ok: 1.5.").size(), 1u);
  EXPECT_FALSE(Log("SSM rep Rate = 1.5").empty());
  Run(options("Pitch"), {"to @SRM set Input.text = Higher!", "set Wait = IDLE"});
  EXPECT_EQ(Log("CHAT rep Reply = It says: error: this slot may not be set.").size(), 1u);
  EXPECT_TRUE(Log("rep Pitch").empty());
}

TEST_F(ChatHubTest, AnErrorIsSpokenAndEverythingGoesOn) {
  const std::string options = R"(, "--model-url", ")" + Url() + R"(", "--model", "500")";
  Run(options, {"to @SRM set Input.text = Hello", "set Wait = IDLE", "to @CHAT set Model = echo",
                "to @SRM set Input.text = Again", "set Wait = IDLE"});
  EXPECT_EQ(Log("set#c4 Speak = I am sorry, I cannot reach my thoughts just now.").size(), 1u);
  EXPECT_EQ(Log("CHAT rep Reply = You said: Again. That is all I know.").size(), 1u)
      << testing::PrintToString(Log("CHAT"));
}

}  // namespace
