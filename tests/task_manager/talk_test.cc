// <object classid="builtin:chat">: a dialogue lends its user to the module CHAT and takes back,
// with the real programs.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/process.h"

namespace vxml_test {
namespace {

using Lines = std::vector<std::string>;
using support::Process;

class TalkTest : public ::testing::Test {
 protected:
  /// `chat`: further words of its command line, each with ", " before; null: there is no such
  /// module.
  void StartHub(const char* chat, const std::string& clock = "virtual") {
    const std::string bin = GALATEA_BIN_DIR;
    std::ofstream config(folder_ / "hub.json");
    config << R"({"clock": ")" << clock << R"(", "listen": [{"role": "owner", "at": "unix:)"
           << folder_ / "hub"
           << R"("}], "modules": [{"name": "SSM", "command": [")" << bin
           << R"(/ssm_stub"]}, {"name": "SRM", "command": [")" << bin << R"(/srm_stub"]})";
    if (chat != nullptr) {
      config << R"(, {"name": "CHAT", "command": [")" << bin << R"(/chat", "--no-listen")" << chat
             << R"(], "after": ["SSM", "SRM"]})";
    }
    config << "]}";
    config.close();
    hub_ = std::make_unique<Process>(
        Lines{bin + "/agent_manager", "--config", folder_ / "hub.json", "--log", folder_ / "log"});
    hub_->WriteLine("inq#up Slots");
    ASSERT_TRUE(hub_->Expect("#up Slots"));
    if (chat == nullptr) return;
    hub_->WriteLine("to @CHAT inq#chat Run");
    ASSERT_TRUE(hub_->Expect("rep#chat Run = LIVE"));
  }
  /// Where a stand-in for a model answers as `model` says.
  std::string WithModel(const std::string& model) {
    server_ =
        std::make_unique<Process>(Lines{"python3", GALATEA_SOURCE_DIR "/tests/chat/stub_model.py"});
    return R"(, "--model-url", "http://127.0.0.1:)" + server_->ReadLine().value_or("") +
           R"(", "--model", ")" + model + "\"";
  }
  /// The transcript of a form whose object `c` has that content.
  Lines Talk(const std::string& object, const std::string& script, const std::string& more = "") {
    std::ofstream(folder_ / "d.vxml")
        << "<vxml version=\"2.1\"><form>" << more << "<object name=\"c\" classid=\"builtin:chat\">"
        << object << "<filled><log expr=\"JSON.stringify(c)\"/></filled></object>"
        << "<field name=\"f\" type=\"boolean\"><prompt>Back?</prompt><filled><exit expr=\"f\"/>"
        << "</filled></field></form></vxml>";
    std::ofstream(folder_ / "s.txt") << script;
    Process dialogue({GALATEA_BIN_DIR "/task_manager", folder_ / "d.vxml", "--connect",
                      "unix:" + (folder_ / "hub"), "--script", folder_ / "s.txt"});
    Lines lines = dialogue.ReadAll();
    code_ = dialogue.Wait();
    errors_ = dialogue.ErrorText();
    return lines;
  }
  static bool Has(const Lines& lines, const std::string& part) {
    return std::ranges::any_of(lines, [&](const std::string& l) { return l.contains(part); });
  }
  std::string Log() {
    hub_->Terminate();
    hub_->Wait();
    std::ifstream file(folder_ / "log");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  support::TempDir folder_;
  std::unique_ptr<Process> hub_, server_;
  std::optional<int> code_{};
  std::string errors_;
};

const std::string kBack = R"("type":"exit","reason":"exit","value":true)";

TEST_F(TalkTest, RulesAnswerUntilAPhraseAndTheDialogueGoesOn) {
  StartHub("");
  const Lines lines = Talk("<prompt>Talk.</prompt><param name=\"end\" value=\"that is all\"/>",
                           "say hello\nsay that is all\nsay yes\n");
  EXPECT_TRUE(Has(lines, R"("text":"Hello!")")) << testing::PrintToString(lines);
  EXPECT_TRUE(Has(lines, R"(\"reason\":\"ended\",\"result\":\"\",\"turns\":2)"))
      << testing::PrintToString(lines);
  EXPECT_TRUE(Has(lines, R"(\"last\":\"that is all\")"));
  EXPECT_TRUE(Has(lines, kBack));
  EXPECT_EQ(code_, 0) << errors_;
  const std::string log = Log();
  EXPECT_GT(log.rfind("Grammar.load = dialog_DM"), log.find("rep Heard = that is all"))
      << "the ear has the dialogue's grammar again";
}

TEST_F(TalkTest, AModelIsToldTheGoalAndGivesTheResult) {
  StartHub(WithModel("say Kyoto it is. [end kyoto]").c_str());
  const Lines lines =
      Talk("<param name=\"goal\" expr=\"'Which city' + '?'\"/>", "say kyoto\nsay yes\n");
  EXPECT_TRUE(Has(lines, R"(\"reason\":\"ended\",\"result\":\"kyoto\",\"turns\":1)"))
      << testing::PrintToString(lines);
  EXPECT_TRUE(Has(lines, R"({\"text\":\"Kyoto it is.\",\"who\":\"agent\"})"));
  EXPECT_TRUE(Has(lines, kBack)) << testing::PrintToString(lines);
  EXPECT_TRUE(Log().contains("Talk.goal = Which city?"));
}

TEST_F(TalkTest, ItEndsAfterSoManyTurnsOrInSilence) {
  StartHub("");
  EXPECT_TRUE(Has(Talk("<param name=\"turns\" value=\"1\"/>", "say hello\nsay yes\n"),
                  R"(\"reason\":\"turns\",\"result\":\"\",\"turns\":1)"));
  const Lines lines = Talk("<param name=\"silence\" value=\"7s\"/>", "silence\nsay yes\n");
  EXPECT_TRUE(Has(lines, R"(\"reason\":\"silence\",\"result\":\"\",\"turns\":0)"))
      << testing::PrintToString(lines);
  EXPECT_TRUE(Has(lines, kBack));
}

TEST_F(TalkTest, WhoeverSpeaksMeanwhileIsListenedTo) {
  StartHub(WithModel("echo").c_str());
  const Lines lines = Talk("<param name=\"turns\" value=\"2\"/>",
                           "say one two three four five six seven\nsay at=1s eight\nsay yes\n");
  EXPECT_TRUE(Has(lines, R"(\"reason\":\"turns\",\"result\":\"\",\"turns\":2)"))
      << testing::PrintToString(lines);
  EXPECT_FALSE(Has(lines, R"(You said: one two three four five six seven. That is all I know.\")"));
  EXPECT_TRUE(Has(lines, R"(\"text\":\"You said: eight. That is all I know.\")"))
      << testing::PrintToString(lines);
}

TEST_F(TalkTest, AModelThatDoesNotAnswerIsABadFetch) {
  StartHub(WithModel("500").c_str());
  const Lines lines =
      Talk("", "say hello\n", "<catch event=\"error.badfetch\"><exit expr=\"_message\"/></catch>");
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines.back().contains("object 'builtin:chat': ")) << lines.back();
  EXPECT_TRUE(lines.back().contains("500")) << lines.back();
}

TEST_F(TalkTest, WithoutTheModuleTheObjectIsUnsupported) {
  StartHub(nullptr);
  const Lines lines = Talk("", "say hello\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines.back().contains("error.unsupported.objectname")) << lines.back();
  EXPECT_TRUE(Has(lines, "there is no @CHAT")) << testing::PrintToString(lines);
}

TEST_F(TalkTest, WhatIsLentAlreadyIsNoResource) {
  StartHub("");
  hub_->WriteLine("to @CHAT set#other Talk = 5 0");
  hub_->WriteLine("to @CHAT inq#now Busy");
  ASSERT_TRUE(hub_->Expect("rep#now"));
  const Lines lines = Talk("", "say hello\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines.back().contains("error.noresource")) << lines.back();
}

TEST_F(TalkTest, AHangUpGivesTheConversationBack) {
  StartHub("");
  const Lines lines = Talk("", "say hello\nhangup\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_TRUE(lines.back().contains("hangup")) << lines.back();
  hub_->WriteLine("to @CHAT set#again Talk = STOP");
  EXPECT_TRUE(hub_->Expect("rep#again"));
  EXPECT_TRUE(Log().contains("Talk.over = STOPPED 1 hello"));
}

TEST_F(TalkTest, ADialogueThatDiesGivesTheConversationBack) {
  StartHub("", "real");
  std::ofstream(folder_ / "d.vxml")
      << "<vxml version=\"2.1\"><form><object name=\"c\" classid=\"builtin:chat\"/></form></vxml>";
  Process dialogue({GALATEA_BIN_DIR "/task_manager", folder_ / "d.vxml", "--connect",
                    "unix:" + (folder_ / "hub"), "--transcript", "json"});
  dialogue.WriteLine("hello");
  ASSERT_TRUE(dialogue.Expect("Hello!")) << dialogue.ErrorText();
  dialogue.Kill();
  dialogue.Wait();
  EXPECT_TRUE(hub_->Expect("From @CHAT rep Talk.over = STOPPED 1 hello")) << hub_->Seen();
  hub_->WriteLine("to @CHAT set#again Talk = 1 1");
  EXPECT_TRUE(hub_->Expect("rep#again Talk = SILENCE 0")) << hub_->Seen();
}

TEST_F(TalkTest, WrongParametersAreSemanticErrors) {
  StartHub("");
  for (const auto& [name, value, said] : {std::tuple("turns", "0", "a number from 1 to 1000"),
                                          {"turns", "2x", "a number"},
                                          {"silence", "10", "a time such as 10s, up to 600s"},
                                          {"maxtime", "2h", "up to 3600s"},
                                          {"prompt", "x", "there is no parameter 'prompt'"}}) {
    const Lines lines =
        Talk("<param name=\"" + std::string(name) + "\" value=\"" + value + "\"/>", "say hello\n");
    ASSERT_FALSE(lines.empty());
    EXPECT_TRUE(lines.back().contains("error.semantic")) << lines.back();
    EXPECT_TRUE(Has(lines, said)) << testing::PrintToString(lines);
  }
}

TEST_F(TalkTest, WhatIsTypedIsSaidInTurns) {
  StartHub("", "real");
  std::ofstream(folder_ / "d.vxml")
      << "<vxml version=\"2.1\"><form><object name=\"c\" classid=\"builtin:chat\"><param "
         "name=\"end\" value=\"that is all\"/><filled><exit expr=\"c.turns\"/></filled></object>"
         "</form></vxml>";
  Process dialogue({GALATEA_BIN_DIR "/task_manager", folder_ / "d.vxml", "--connect",
                    "unix:" + (folder_ / "hub"), "--transcript", "json"});
  dialogue.WriteLine("hello");
  dialogue.WriteLine("that is all");
  dialogue.CloseInput();
  const Lines lines = dialogue.ReadAll();
  EXPECT_EQ(dialogue.Wait(), 0) << dialogue.ErrorText();
  EXPECT_TRUE(Has(lines, R"("text":"Hello!")")) << testing::PrintToString(lines);
  EXPECT_TRUE(Has(lines, R"("value":2)")) << testing::PrintToString(lines);
}

}  // namespace
}  // namespace vxml_test
