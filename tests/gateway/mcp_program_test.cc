// The hub, a voice without sound, and mcp between them and a client (mcp_client.py).

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/process.h"

namespace {

using support::Process;

class McpProgramTest : public testing::Test {
 protected:
  McpProgramTest() {
    std::ofstream(folder_ / "c.json")
        << R"({"listen": ["unix:)" << (folder_ / "hub")
        << R"("], "modules": [{"name": "SSM", "command": [")" GALATEA_BIN_DIR
           R"(/ssm_stub"]}, {"name": "DEAF", "command": ["sh", "-c",
           "echo rep Run = LIVE; exec sleep 1000"]}]})";
    hub_ = std::make_unique<Process>(
        std::vector<std::string>{GALATEA_BIN_DIR "/agent_manager", "--config", folder_ / "c.json"});
    hub_->WriteLine("to @SSM inq#1 Speak.stat");
    EXPECT_TRUE(hub_->Expect("rep#1 ")) << hub_->ErrorText();
  }
  support::TempDir folder_;
  std::unique_ptr<Process> hub_;
};

TEST_F(McpProgramTest, AClientOfEitherRevisionHoldsAConversation) {
  for (const char* revision : {"2025-11-25", "2025-06-18"}) {
    Process client({"python3", GALATEA_SOURCE_DIR "/tests/gateway/mcp_client.py", revision,
                    GALATEA_BIN_DIR "/mcp", "--connect", "unix:" + (folder_ / "hub"), "--allow",
                    "@SSM Rate", "--allow", "@SSM Text*"});
    client.CloseInput();
    EXPECT_TRUE(client.Expect("ok")) << client.Seen() << client.ErrorText();
    EXPECT_EQ(client.Wait(), 0);
  }
}

TEST_F(McpProgramTest, OverHttpTheSameConversationIsHeldAndStrangersAreRefused) {
  Process mcp({GALATEA_BIN_DIR "/mcp", "--connect", "unix:" + (folder_ / "hub"), "--allow",
               "@SSM Rate", "--allow", "@SSM Text*", "--http", "tcp:127.0.0.1:0"});
  const std::string url = mcp.ReadLine().value_or("");
  ASSERT_TRUE(url.starts_with("http://127.0.0.1:")) << mcp.ErrorText();
  for (const char* revision : {"2025-11-25", "2025-06-18"}) {
    Process client({"python3", GALATEA_SOURCE_DIR "/tests/gateway/mcp_client.py", revision, url});
    client.CloseInput();
    EXPECT_TRUE(client.Expect("ok")) << client.Seen() << client.ErrorText();
    EXPECT_EQ(client.Wait(), 0);
  }
  mcp.Terminate();
  EXPECT_EQ(mcp.Wait(), 0) << mcp.ErrorText();
  EXPECT_NE(mcp.ErrorText().find("refused"), std::string::npos) << "strangers are";
  EXPECT_EQ(mcp.ErrorText().find("neither POST nor DELETE"), std::string::npos)
      << "whoever asks for a stream is not: " << mcp.ErrorText();
}

TEST_F(McpProgramTest, ClientsWhoGoLeaveTheirPlacesAtOnceThoughAModuleNeverAnswers) {
  Process mcp({GALATEA_BIN_DIR "/mcp", "--connect", "unix:" + (folder_ / "hub"), "--allow",
               "@DEAF *", "--http", "tcp:127.0.0.1:0"});
  const std::string url = mcp.ReadLine().value_or("");
  Process crowd({"python3", GALATEA_SOURCE_DIR "/tests/gateway/mcp_crowd.py", url});
  crowd.CloseInput();
  EXPECT_TRUE(crowd.Expect("ok")) << crowd.Seen() << crowd.ErrorText() << mcp.ErrorText();
  EXPECT_EQ(crowd.Wait(), 0);
}

TEST_F(McpProgramTest, HttpForOtherMachinesNeedsATokenOfItsOwn) {
  Process mcp({GALATEA_BIN_DIR "/mcp", "--connect", "unix:" + (folder_ / "hub"), "--allow",
               "@SSM Rate", "--http", "tcp:0.0.0.0:0"});
  EXPECT_EQ(mcp.Wait(), 1);
  EXPECT_TRUE(mcp.ErrorText().starts_with("mcp: --http: ")) << mcp.ErrorText();
}

TEST_F(McpProgramTest, WithoutItsHubItEndsWithOneSentence) {
  Process mcp(
      {GALATEA_BIN_DIR "/mcp", "--connect", "unix:" + (folder_ / "hub"), "--allow", "@SSM Rate"});
  mcp.WriteLine(R"({"jsonrpc": "2.0", "id": 1, "method": "ping"})");
  EXPECT_TRUE(mcp.Expect("\"result\":{}"));
  hub_->Kill();
  hub_->Wait();
  EXPECT_EQ(mcp.Wait(), 1);
  EXPECT_TRUE(mcp.ErrorText().starts_with("mcp: the hub has gone")) << mcp.ErrorText();
  Process nowhere(
      {GALATEA_BIN_DIR "/mcp", "--connect", "unix:/nowhere/hub", "--allow", "@SSM Rate"});
  nowhere.CloseInput();
  EXPECT_EQ(nowhere.Wait(), 1);
  EXPECT_TRUE(nowhere.ErrorText().contains("/nowhere/hub")) << nowhere.ErrorText();
}

}  // namespace
