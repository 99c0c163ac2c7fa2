#include "chat/model/model_request.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "tests/chat/fake_transport.h"

namespace chat {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class ModelRequestTest : public testing::Test {
 protected:
  ModelRequestTest() {
    request_.emplace(
        clock_, net_, vm::HttpRequest{.url = "http://x/v1", .headers = {}, .body = "{}"},
        "sk-secret", ModelLimits{.whole = seconds(60), .stall = seconds(15), .reply_bytes = 20},
        ModelRequest::Events{.began = [this] { ++began_; },
                             .words = [this](const std::string& w) { words_ += w; },
                             .end = [this](auto end) { ends_.push_back(end); }});
  }
  const ModelFailure& Failure() {
    EXPECT_EQ(ends_.size(), 1u);
    EXPECT_FALSE(ends_.at(0));
    return ends_.at(0).error();
  }
  vm::VirtualScheduler clock_;
  chat_test::FakeTransport net_;
  std::optional<ModelRequest> request_;
  int began_ = 0;
  std::string words_;
  std::vector<std::expected<std::vector<ToolCall>, ModelFailure>> ends_;
};

TEST_F(ModelRequestTest, WordsComeAsTheyAreSaid) {
  net_.Head(200);
  net_.Words("Hi ");
  EXPECT_EQ(words_, "Hi ");
  net_.Words("you.");
  net_.Done();
  net_.Words("never");
  net_.End();
  EXPECT_EQ(words_, "Hi you.");
  EXPECT_EQ(began_, 1);
  ASSERT_EQ(ends_.size(), 1u);
  EXPECT_TRUE(ends_[0]);
  EXPECT_EQ(clock_.pending(), 0u);
}

TEST_F(ModelRequestTest, SilenceEndsItToTheMillisecond) {
  clock_.RunUntil(milliseconds(14'999));
  net_.Head(200);
  clock_.RunUntil(milliseconds(29'998));
  EXPECT_TRUE(ends_.empty());
  clock_.RunUntil(milliseconds(29'999));
  EXPECT_EQ(Failure().trouble, Trouble::kLate);
  EXPECT_EQ(Failure().error.code, vm::Errc::kTimeout);
}

TEST_F(ModelRequestTest, AReplyThatDripsEndsWithItsTime) {
  net_.Head(200);
  for (int i = 1; i < 60; ++i) {
    clock_.RunUntil(seconds(i));
    net_.Data(": still here\n");
  }
  clock_.RunUntil(seconds(60));
  EXPECT_EQ(Failure().trouble, Trouble::kLate);
}

TEST_F(ModelRequestTest, TooManyWordsAreCutAtALetter) {
  net_.Head(200);
  net_.Words("0123456789");
  net_.Words("012345678あああ");
  EXPECT_EQ(words_, "0123456789012345678");
  EXPECT_EQ(Failure().trouble, Trouble::kLong);
}

TEST_F(ModelRequestTest, TheKeyIsNeverShown) {
  net_.Head(401, {});
  net_.Data("{\"error\":{\"message\":\"Incorrect key sk-secret, sk-secret\"}}");
  net_.End();
  EXPECT_EQ(Failure().trouble, Trouble::kRefused);
  EXPECT_EQ(Failure().error.text, "http://x/v1: the key is refused, 401: Incorrect key ***, ***");
}

TEST_F(ModelRequestTest, TooManyRequestsTellHowLongToWait) {
  net_.Head(429, {{"retry-after", "7"}});
  net_.End();
  EXPECT_EQ(Failure().trouble, Trouble::kBusy);
  EXPECT_EQ(Failure().wait, seconds(7));
}

TEST_F(ModelRequestTest, RedirectionsAreNotFollowed) {
  net_.Head(307, {{"location", "http://evil/"}});
  net_.End();
  EXPECT_TRUE(Failure().error.text.contains("has moved to 'http://evil/'"));
  EXPECT_EQ(net_.calls.size(), 1u);
}

TEST_F(ModelRequestTest, WhatBreaksOffIsAnError) {
  net_.Head(200);
  net_.Words("Hi.");
  net_.End(vm::Fail(vm::Errc::kUnavailable, "gone"));
  EXPECT_EQ(words_, "Hi.");
  EXPECT_EQ(Failure().trouble, Trouble::kBroken);
}

TEST_F(ModelRequestTest, AnEndpointThatIsNotThereIsAway) {
  net_.End(vm::Fail(vm::Errc::kUnavailable, "Couldn't connect to server"));
  EXPECT_EQ(Failure().trouble, Trouble::kAway);
}

TEST_F(ModelRequestTest, GoingAwayClosesTheConnection) {
  net_.Head(200);
  request_.reset();
  EXPECT_FALSE(net_.last().open);
  EXPECT_EQ(clock_.pending(), 0u);
}

}  // namespace
}  // namespace chat
