#include "chat/model/reply_reader.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "chat/model/endpoint.h"
#include "vm_protocol/http/answer.h"

namespace chat {
namespace {

using Texts = std::vector<std::string>;

Texts Events(const std::string& stream, std::size_t piece) {
  SseReader reader;
  Texts events;
  for (std::size_t at = 0; at < stream.size(); at += piece) {
    auto some = reader.Feed(stream.substr(at, piece));
    if (!some) return {"ERROR"};
    events.insert(events.end(), some->begin(), some->end());
  }
  return events;
}

TEST(SseReaderTest, EventsAreReadHoweverTheyAreCut) {
  const std::string stream =
      "\xEF\xBB\xBF"
      "data: one\n\n: comment\nevent: x\ndata:two\r\ndata: more\r\n\r\nid: 3\rdata\r\rdata: lost";
  for (std::size_t piece = 1; piece <= stream.size(); ++piece)
    EXPECT_EQ(Events(stream, piece), (Texts{"one", "two\nmore", ""})) << piece;
}

TEST(SseReaderTest, GiantLinesAndEventsAreRefused) {
  EXPECT_EQ(Events(std::string(SseReader::kMaxEventBytes + 2, 'x'), 4096), Texts{"ERROR"});
  std::string many;
  while (many.size() < 2 * SseReader::kMaxEventBytes)
    many += "data: " + std::string(1000, 'x') + "\n";
  EXPECT_EQ(Events(many, 4096), Texts{"ERROR"});
}

/// The words, and the error's code if there is one.
std::string Read(const std::string& stream, std::size_t piece, bool streams = true) {
  ReplyReader reader(streams);
  std::string words;
  vm::Result<void> end;
  for (std::size_t at = 0; at < stream.size() && end; at += piece)
    end = reader.Feed(stream.substr(at, piece), words);
  if (end) end = reader.End(words);
  return end ? words : words + "|" + std::string(vm::ErrcName(end.error().code));
}

std::string Chunk(const std::string& words) {
  return "data: {\"choices\":[{\"delta\":{\"content\":\"" + words + "\"}}]}\n\n";
}

TEST(ReplyReaderTest, WordsOfAStreamAreJoined) {
  const std::string stream =
      "data: {\"choices\":[{\"delta\":{\"role\":\"assistant\",\"content\":null}}]}\n\n" +
      Chunk("Hel") + Chunk("lo.") + "data: {\"choices\":[]}\n\ndata: [DONE]\n\n";
  for (const std::size_t piece : {1U, 10U, 1000U}) EXPECT_EQ(Read(stream, piece), "Hello.");
  EXPECT_EQ(
      Read(Chunk("Hi.") + "data: {\"choices\":[{\"delta\":{},\"finish_reason\":\"stop\"}]}\n\n", 9),
      "Hi.");
}

TEST(ReplyReaderTest, AnAnswerThatIsNoStreamIsRead) {
  EXPECT_EQ(Read("{\"choices\":[{\"message\":{\"content\":\"Hi.\"}}]}", 7, false), "Hi.");
  EXPECT_EQ(
      Read("{\"choices\":[{\"message\":{\"content\":[{\"type\":\"text\",\"text\":\"Hi.\"}]}}]}", 7,
           false),
      "Hi.");
  EXPECT_EQ(Read("no", 7, false), "|SYNTAX");
}

TEST(ReplyReaderTest, FaultsKeepWhatCameBefore) {
  EXPECT_EQ(Read(Chunk("Hi.") + "data: nonsense\n\n", 1000), "Hi.|SYNTAX");
  EXPECT_EQ(Read(Chunk("Hi."), 1000), "Hi.|UNAVAILABLE") << "it broke off";
  EXPECT_EQ(Read(Chunk("Hi.") + "data: {\"error\":{\"message\":\"no memory\"}}\n\n", 1000),
            "Hi.|UNAVAILABLE");
  for (const std::string& data : {std::string(100000, '['), std::string("[]"), std::string("5"),
                                  std::string("{\"a\":1}"), std::string("{\"choices\":5}")})
    EXPECT_EQ(Read("data: " + data + "\n\n", 4096), "|SYNTAX") << data.substr(0, 20);
  for (const char* const data : {"{\"choices\":[5]}", "{\"choices\":[{\"delta\":[]}]}",
                                 "{\"choices\":[{\"delta\":{\"content\":{}}}]}"})
    EXPECT_EQ(Read(std::string("data: ") + data + "\n\ndata: [DONE]\n\n", 4096), "") << data;
}

TEST(ReplyReaderTest, ToolCallsAreJoined) {
  const auto piece = [](const std::string& call) {
    return "data: {\"choices\":[{\"delta\":{\"tool_calls\":[" + call + "]}}]}\n\n";
  };
  ReplyReader reader(true);
  std::string words;
  ASSERT_TRUE(reader.Feed(piece("{\"index\":0,\"id\":\"a\",\"function\":{\"name\":\"set_slot\","
                                "\"arguments\":\"{\\\"x\"}}") +
                              piece("{\"index\":1,\"id\":\"b\",\"function\":{\"name\":\"f\"}}") +
                              piece("{\"index\":0,\"function\":{\"arguments\":\"\\\":1}\"}}"),
                          words));
  EXPECT_EQ(reader.tool_calls(),
            (std::vector<ToolCall>{{"a", "set_slot", "{\"x\":1}"}, {"b", "f", ""}}));
  EXPECT_FALSE(reader.Feed(piece("{\"index\":99}"), words));
}

TEST(ErrorTextTest, WhatTheEndpointSaysIsShownOnOneLine) {
  EXPECT_EQ(vm::ErrorTextOf("{\"error\":{\"message\":\"bad\\nkey\"}}"), "bad key");
  EXPECT_EQ(vm::ErrorTextOf("{\"detail\":\"no\"}"), "no");
  EXPECT_EQ(vm::ErrorTextOf("<html>\x1b[31m"), "<html> [31m");
  EXPECT_LE(vm::ErrorTextOf(std::string(5000, 'x')).size(), 200u);
}

TEST(EndpointTest, TheAddressOfChatCompletionsIsMade) {
  EXPECT_EQ(*ChatUrl("http://localhost:8080"), "http://localhost:8080/v1/chat/completions");
  EXPECT_EQ(*ChatUrl("https://api.x/v1/"), "https://api.x/v1/chat/completions");
  EXPECT_EQ(*ChatUrl("https://x/a/chat/completions"), "https://x/a/chat/completions");
  for (const char* const wrong :
       {"", "localhost:80", "file:///etc/passwd", "http://", "http://u:p@x", "http://x y",
        "http://x/?a=b", "http://x\r\nA: b"})
    EXPECT_FALSE(ChatUrl(wrong)) << wrong;
}

TEST(EndpointTest, SlotsThatMayBeSetHaveAModule) {
  EXPECT_EQ(ParseAllowed("@FSM FaceExp.onset")->slot, "FaceExp.onset");
  for (const char* const wrong : {"", "@FSM", "Mask", "@FSM Ma sk", "@FSM ", "@@X Y"})
    EXPECT_FALSE(ParseAllowed(wrong)) << wrong;
}

}  // namespace
}  // namespace chat
