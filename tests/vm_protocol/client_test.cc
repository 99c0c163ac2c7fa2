#include "vm_protocol/core/client.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vm {
namespace {

TEST(ClientTest, PairsAnswersWithQuestions) {
  std::vector<std::string> sent;
  std::vector<std::string> answers;
  Client client([&](std::string_view line) { sent.emplace_back(line); });
  const auto keep = [&](Result<std::string> value) {
    answers.push_back(value ? *value
                            : std::string(ErrcName(value.error().code)) + "|" + value.error().text);
  };
  client.Request(To("SSM", Inq("Speaker")), keep);
  client.Request(Set("Volume", "999"), keep);
  EXPECT_EQ(sent, (std::vector<std::string>{"to @SSM inq#c1 Speaker", "set#c2 Volume = 999"}));
  client.HandleLine(
      "From @SSM rep#c2 Volume.error = BAD_VALUE column 1: found '999', expected <number 0..200>");
  client.HandleLine("From @SSM rep#c1 Speaker = slt");
  client.HandleLine("From @SSM rep#c1 Speaker = again");
  EXPECT_EQ(answers, (std::vector<std::string>{
                         "BAD_VALUE|column 1: found '999', expected <number 0..200>", "slt"}));
  EXPECT_EQ(client.pending(), 0u);
}

TEST(ClientTest, ReportsGoToTheirListenersAndTheRestToTheOneForAll) {
  Client client([](std::string_view) {});
  std::vector<std::string> heard;
  client.On("Speak.stat",
            [&](const Message& message) { heard.push_back("stat " + message.value); });
  client.On("",
            [&](const Message& message) { heard.push_back("other " + FormatMessage(message)); });
  client.HandleLine("From @SSM rep Speak.stat = IDLE");
  client.HandleLine("From @SSM tell Speak.sync = 1000");
  client.HandleLine("garbage");
  EXPECT_EQ(heard,
            (std::vector<std::string>{"stat IDLE", "other From @SSM tell Speak.sync = 1000"}));
}

TEST(ClientTest, AbandoningEndsRequestsNobodyAnswers) {
  Client client([](std::string_view) {});
  int ended = 0;
  const auto count = [&](Result<std::string> value) { ended += value ? 0 : 1; };
  const std::string first = client.Request(Inq("A"), count);
  client.Request(Inq("B"), count);
  client.Abandon(first, {Errc::kTimeout, "no answer", 0});
  EXPECT_EQ(ended, 1);
  client.Abandon("", {Errc::kUnavailable, "gone", 0});
  EXPECT_EQ(ended, 2);
}

}  // namespace
}  // namespace vm
