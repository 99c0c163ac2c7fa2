// The agent platform with the real hub and the voice's, the ear's and a face-less stack: the
// programs as people run them.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/process.h"

namespace vxml_test {
namespace {

class AgentTest : public ::testing::Test {
 protected:
  AgentTest() {
    const std::string bin = GALATEA_BIN_DIR;
    std::ofstream(folder_ / "hub.json")
        << "{\"clock\": \"virtual\", \"listen\": [\"unix:" << folder_ / "hub"
        << "\"], \"modules\": [{\"name\": \"SSM\", \"command\": [\"" << bin
        << "/ssm_stub\"]}, {\"name\": \"SRM\", \"command\": [\"" << bin << "/srm_stub\"]}]}";
    hub_ = std::make_unique<support::Process>(
        std::vector<std::string>{bin + "/agent_manager", "--config", folder_ / "hub.json", "--log",
                                 folder_ / "log"},
        support::Process::Options{.cwd = folder_.path(), .env = {}});
    hub_->WriteLine("inq#up Slots");
    EXPECT_TRUE(hub_->Expect("#up Slots"));
  }

  std::vector<std::string> Talk(const std::string& document, const std::string& script) {
    std::ofstream(folder_ / "d.vxml") << document;
    std::ofstream(folder_ / "s.txt") << script;
    support::Process dialogue(
        std::vector<std::string>{GALATEA_BIN_DIR "/task_manager", folder_ / "d.vxml", "--connect",
                                 "unix:" + (folder_ / "hub"), "--script", folder_ / "s.txt"},
        support::Process::Options{.cwd = folder_.path(), .env = {}});
    auto lines = dialogue.ReadAll();
    EXPECT_EQ(dialogue.Wait(), 0) << dialogue.ErrorText();
    return lines;
  }

  std::string Log() {
    std::ifstream file(folder_ / "log");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  support::TempDir folder_;
  std::unique_ptr<support::Process> hub_;
};

TEST_F(AgentTest, SpeaksHearsAndMovesTheFaceThroughTheHub) {
  const auto lines = Talk(
      "<vxml version=\"2.1\"><form><field name=\"f\" type=\"boolean\"><prompt>Do you <emotion "
      "type=\"HAPPY\" value=\"80\">like it</emotion>?</prompt><nomatch>Yes or no?<reprompt/>"
      "</nomatch><filled><prompt>Thank you.</prompt><exit "
      "expr=\"f\"/></filled></field></form></vxml>",
      "say perhaps\nsay yes\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("\"value\":true"), std::string::npos) << lines.back();
  const std::string log = Log();
  EXPECT_NE(log.find("Do you<BOOKMARK MARK=\"d0\"/> like it<BOOKMARK MARK=\"d1\"/> ?"),
            std::string::npos);
  bool smiled = false;
  for (const std::string& line : lines) {
    smiled = smiled || line.find("set FaceExp = HAPPY 1 80 0") != std::string::npos;
  }
  EXPECT_TRUE(smiled);
  EXPECT_NE(log.find("Thank you."), std::string::npos);
}

TEST_F(AgentTest, RecordingIsRefusedWithItsEvent) {
  const auto lines = Talk(
      "<vxml version=\"2.1\"><form><record name=\"r\"><catch "
      "event=\"error.unsupported.record\"><exit expr=\"'refused'\"/></catch></record>"
      "</form></vxml>",
      "record 3s\n");
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(lines.back().find("refused"), std::string::npos) << lines.back();
}

}  // namespace
}  // namespace vxml_test
