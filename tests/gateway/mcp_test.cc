// Slots as tools of MCP: schemas, the conversation, what is no message.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gateway/mcp/mcp_server.h"

namespace gateway {
namespace {

using nlohmann::json;
using Lines = std::vector<std::string>;

TEST(SlotToolTest, GrammarsBecomeSchemas) {
  EXPECT_EQ(SchemaOf("ON | OFF"), (json{{"type", "string"}, {"enum", {"ON", "OFF"}}}));
  EXPECT_EQ(SchemaOf("<number 0.25..4>"),
            (json{{"type", "number"}, {"minimum", 0.25}, {"maximum", 4.0}}));
  EXPECT_EQ(SchemaOf("<int 1..120>")["type"], "integer");
  EXPECT_EQ(SchemaOf("<ms>"), (json{{"type", "number"}}));
  EXPECT_EQ(SchemaOf("<text>"), (json{{"type", "string"}}));
  EXPECT_EQ(SchemaOf("NONE | <word>"),
            (json{{"type", "string"}, {"description", "Grammar: NONE | <word>"}}));
  EXPECT_EQ(SchemaOf("( <word> <number 0..1> )...")["description"],
            "Grammar: ( <word> <number 0..1> )...");
}

TEST(SlotToolTest, ASlotSaysWhatItsToolTakes) {
  const SlotTool both = MakeSlotTool("SSM", "Rate", "Speed of speech. Value: <number 0.25..4>",
                                     "AutoOutput ReadWrite default 1");
  EXPECT_EQ(both.Name(), "SSM_Rate");
  EXPECT_EQ(both.help, "Speed of speech.");
  EXPECT_TRUE(both.readable && both.writable);
  EXPECT_EQ(both.Description()["inputSchema"]["required"], json::array());
  const SlotTool told =
      MakeSlotTool("FSM", "Mouth.open", "How far. (read only)", "NoAutoOutput ReadOnly");
  EXPECT_EQ(told.Name(), "FSM_Mouth_open");
  EXPECT_FALSE(told.writable);
  EXPECT_EQ(told.Description()["annotations"]["readOnlyHint"], true);
  EXPECT_EQ(told.Description()["inputSchema"]["properties"], json::object());
  const SlotTool order =
      MakeSlotTool("SSM", "Text", "Prepares. Value: <markup>", "NoAutoOutput WriteOnly");
  EXPECT_EQ(order.Description()["inputSchema"]["required"], json::array({"value"}));
}

TEST(SlotToolTest, PatternsTakeAnyLettersForAStar) {
  EXPECT_TRUE(MatchesPattern("Speak*", "Speak.stat"));
  EXPECT_TRUE(MatchesPattern("face*", "FaceExp"));
  EXPECT_TRUE(MatchesPattern("*.dur", "Text.dur"));
  EXPECT_TRUE(MatchesPattern("*", ""));
  EXPECT_FALSE(MatchesPattern("Speak", "Speak.stat"));
  EXPECT_FALSE(MatchesPattern("*.dur", "Text.durs"));
}

TEST(SlotToolTest, WhatIsNoAllowanceIsNamed) {
  EXPECT_EQ(ParseAllowed("@FSM Face*")->slot, "Face*");
  EXPECT_EQ(ParseAllowed("Mask").error().text, "found 'Mask', expected @MODULE SLOT");
  EXPECT_FALSE(ParseAllowed("@FSM a b"));
}

/// A hub of two modules, played by the test.
class McpServerTest : public testing::Test {
 protected:
  McpServer::GiveUp Ask(const vm::Message& message, const McpServer::OnAnswer& on_answer) {
    const std::string line = vm::FormatMessage(message);
    asked_.push_back(line);
    if (hold_) {
      held_.push_back(on_answer);
      return [this] { ++given_up_; };
    }
    const std::map<std::string, std::string> known{
        {"to @SSM inq Slots", "Rate Text Text.pho SaveWAV"},
        {"to @SSM inq Rate.help", "Speed of speech. Value: <number 0.25..4>"},
        {"to @SSM inq Rate.prop", "AutoOutput ReadWrite default 1"},
        {"to @SSM inq Text.help", "Prepares a text. Value: <markup>"},
        {"to @SSM inq Text.prop", "NoAutoOutput WriteOnly"},
        {"to @SSM inq Text.pho.help", "Its phonemes. (read only)"},
        {"to @SSM inq Text.pho.prop", "AutoOutput ReadOnly"},
        {"to @SSM inq Text.pho", "pau[10]"},
        {"to @SSM set Rate = 1.5", "1.5"},
        {"to @SSM inq Rate", "1"}};
    const auto found = known.find(line);
    if (found != known.end()) {
      on_answer(found->second);
    } else {
      on_answer(vm::Fail(vm::Errc::kUnknownModule, "no such thing"));
    }
    return [] {};
  }
  json Say(const json& message) { return SayText(message.dump()); }
  json SayText(const std::string& text) {
    said_.clear();
    question_ =
        server_.Handle(text, [this](const std::string& answer) { said_.push_back(answer); });
    return said_.empty() ? json() : json::parse(said_.back());
  }
  json Request(const std::string& method, json params = json::object()) {
    return Say({{"jsonrpc", "2.0"}, {"id", 7}, {"method", method}, {"params", std::move(params)}});
  }
  json Call(const std::string& tool, json arguments) {
    return Request("tools/call", {{"name", tool}, {"arguments", std::move(arguments)}});
  }

  Lines asked_, said_;
  McpServer::QuestionPtr question_;  // the last
  int given_up_ = 0;
  bool hold_ = false;
  std::vector<McpServer::OnAnswer> held_;
  McpServer server_{{{"SSM", "Rate"}, {"SSM", "Text*"}},
                    {.ask = [this](const vm::Message& message, const auto& on_answer) {
                      return Ask(message, on_answer);
                    }}};
};

TEST_F(McpServerTest, BothRevisionsAreSpokenAndAnyOtherGetsTheNewest) {
  for (const char* revision : {"2025-11-25", "2025-06-18"}) {
    const json answer = Request("initialize", {{"protocolVersion", revision}});
    EXPECT_EQ(answer["id"], 7);
    EXPECT_EQ(answer["result"]["protocolVersion"], revision);
    EXPECT_TRUE(answer["result"]["capabilities"].contains("tools"));
    EXPECT_EQ(answer["result"]["serverInfo"]["name"], "galatea");
  }
  EXPECT_EQ(Request("initialize", {{"protocolVersion", "1999-01-01"}})["result"]["protocolVersion"],
            "2025-11-25");
  EXPECT_TRUE(Say({{"jsonrpc", "2.0"}, {"method", "notifications/initialized"}}).is_null());
  EXPECT_EQ(Request("ping")["result"], json::object());
}

TEST_F(McpServerTest, ToolsAreWhatIsAllowedOfWhatModulesDeclare) {
  const json tools = Request("tools/list")["result"]["tools"];
  ASSERT_EQ(tools.size(), 3u) << tools;
  EXPECT_EQ(tools[0]["name"], "SSM_Rate");
  EXPECT_EQ(tools[0]["inputSchema"]["properties"]["value"]["maximum"], 4);
  EXPECT_EQ(tools[1]["name"], "SSM_Text");
  EXPECT_EQ(tools[2]["description"], "Its phonemes.");
  const std::size_t questions = asked_.size();
  Request("tools/list");
  EXPECT_EQ(asked_.size(), questions) << "modules are asked once";
}

TEST_F(McpServerTest, ACallSetsOrAsksTheSlot) {
  const json set = Call("SSM_Rate", {{"value", 1.5}});
  EXPECT_EQ(set["result"]["content"][0]["text"], "1.5");
  EXPECT_EQ(set["result"]["isError"], false);
  EXPECT_EQ(Call("SSM_Rate", json::object())["result"]["content"][0]["text"], "1");
  EXPECT_EQ(Call("SSM_Text_pho", json::object())["result"]["content"][0]["text"], "pau[10]");
  const json refused = Call("SSM_Text", {{"value", "Hello"}});
  EXPECT_EQ(refused["result"]["isError"], true) << "the model reads what was wrong";
  EXPECT_EQ(refused["result"]["content"][0]["text"], "UNKNOWN_MODULE no such thing");
}

TEST_F(McpServerTest, WrongCallsAreErrorsAndReachNoModule) {
  Request("tools/list");
  asked_.clear();
  EXPECT_EQ(Call("SSM_SaveWAV", {{"value", "x.wav"}})["error"]["code"], -32602) << "not allowed";
  EXPECT_EQ(Call("SSM_Text", json::object())["error"]["code"], -32602);
  EXPECT_EQ(Call("SSM_Text_pho", {{"value", "a"}})["error"]["code"], -32602);
  EXPECT_EQ(Call("SSM_Rate", {{"value", json::array()}})["error"]["code"], -32602);
  EXPECT_EQ(Call("SSM_Text", {{"value", "a\nto @AM set Run = EXIT"}})["error"]["code"], -32602)
      << "one line is one message";
  EXPECT_EQ(asked_, Lines{});
}

TEST_F(McpServerTest, WhatIsNoMessageIsAnsweredAsJsonRpcHasIt) {
  EXPECT_EQ(SayText("{")["error"]["code"], -32700);
  EXPECT_EQ(SayText("[]")["error"]["code"], -32600) << "batches are none of these revisions";
  EXPECT_EQ(SayText(R"({"id": 1, "method": "ping"})")["error"]["code"], -32600);
  EXPECT_EQ(SayText(R"({"jsonrpc": "2.0", "id": {}, "method": "ping"})")["error"]["code"], -32600);
  EXPECT_EQ(Request("tools/dance")["error"]["code"], -32601);
  EXPECT_EQ(Say({{"jsonrpc", "2.0"}, {"id", "a"}, {"method", "ping"}})["id"], "a");
  EXPECT_TRUE(SayText(R"({"jsonrpc": "2.0", "id": 3, "result": {}})").is_null());
  EXPECT_EQ(SayText(std::string(5000, '['))["error"]["code"], -32700);
}

TEST_F(McpServerTest, MoreCallsThanAllowedAtATimeAreRefused) {
  Request("tools/list");
  hold_ = true;
  for (std::size_t i = 0; i < McpServer::kMaxRunning; ++i) Call("SSM_Rate", json::object());
  EXPECT_EQ(server_.running(), McpServer::kMaxRunning);
  EXPECT_EQ(Call("SSM_Rate", json::object())["error"]["code"], -32000);
  hold_ = false;
  for (const auto& on_answer : std::exchange(held_, {})) on_answer("1");
  EXPECT_EQ(server_.running(), 0u);
  EXPECT_TRUE(Call("SSM_Rate", json::object()).contains("result"));
}

TEST_F(McpServerTest, TheLimitHoldsBeforeTheFirstListingAndForListings) {
  hold_ = true;
  for (std::size_t i = 0; i < McpServer::kMaxRunning; ++i) {
    const json answer = i % 2 == 0 ? Request("tools/list") : Call("SSM_Rate", json::object());
    EXPECT_TRUE(answer.is_null()) << answer;
  }
  EXPECT_EQ(server_.running(), McpServer::kMaxRunning);
  EXPECT_EQ(Request("tools/list")["error"]["code"], -32000);
  EXPECT_EQ(Call("SSM_Rate", json::object())["error"]["code"], -32000);
  EXPECT_EQ(Request("ping")["result"], json::object()) << "what is answered at once needs no place";
  hold_ = false;
  said_.clear();
  for (const auto& on_answer : std::exchange(held_, {})) on_answer("Rate Text");
  EXPECT_EQ(said_.size(), McpServer::kMaxRunning);
  EXPECT_EQ(server_.running(), 0u);
}

TEST_F(McpServerTest, AClientThatGoesLeavesItsPlaceAndItsQuestionIsGivenUp) {
  hold_ = true;
  std::vector<McpServer::QuestionPtr> questions;
  for (std::size_t i = 0; i < McpServer::kMaxRunning; ++i) {
    Request("tools/list");
    questions.push_back(question_);
  }
  for (const auto& question : questions) server_.Forget(question);
  EXPECT_EQ(server_.running(), 0u);
  EXPECT_TRUE(Request("tools/list").is_null());
  hold_ = false;
  for (const auto& on_answer : std::exchange(held_, {})) on_answer("Rate Text");
  EXPECT_EQ(said_.size(), 1u) << "only who has stayed is answered";
  hold_ = true;
  EXPECT_TRUE(Call("SSM_Rate", json::object()).is_null());
  server_.Forget(question_);
  EXPECT_EQ(given_up_, 1);
  EXPECT_EQ(server_.running(), 0u);
  for (const auto& on_answer : std::exchange(held_, {})) on_answer("1");
  EXPECT_TRUE(said_.empty());
}

TEST_F(McpServerTest, AModuleThatDidNotAnswerIsAskedAgain) {
  McpServer server({{"NONE", "*"}},
                   {.ask = [this](const vm::Message& message, const auto& on_answer) {
                     return Ask(message, on_answer);
                   }});
  for (int i = 0; i < 2; ++i) {
    server.Handle(R"({"jsonrpc": "2.0", "id": 1, "method": "tools/list"})",
                  [this](const std::string& answer) { said_.push_back(answer); });
    EXPECT_EQ(json::parse(said_.back())["result"]["tools"], json::array());
  }
  EXPECT_EQ(asked_, (Lines{"to @NONE inq Slots", "to @NONE inq Slots"}));
}

}  // namespace
}  // namespace gateway
