#include "agent_manager/session/error_stream.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <string>

namespace {

using am::ErrorStream;

class ErrorStreamTest : public testing::Test {
 protected:
  static std::array<int, 2> LargePipe() {
    std::array<int, 2> ends{-1, -1};
    EXPECT_EQ(pipe2(ends.data(), O_NONBLOCK), 0);
    EXPECT_GT(fcntl(ends[1], F_SETPIPE_SZ, 1 << 20), 0);
    return ends;
  }
  ~ErrorStreamTest() override {
    for (const int end : ends_) close(end);
  }
  std::string Read() {
    std::string text(1 << 20, 0);
    const ssize_t n = read(ends_[0], text.data(), text.size());
    text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return text;
  }

  const std::array<int, 2> ends_ = LargePipe();
  std::chrono::steady_clock::time_point now_{};
  ErrorStream stream_{ends_[1], [this] { return now_; }};
};

TEST_F(ErrorStreamTest, AFloodOfErrorsFillsNoDiskAndIsCounted) {
  for (int i = 0; i < 100'000; ++i) stream_.Write("an error that a peer has caused");
  const std::string flood = Read();
  EXPECT_LE(flood.size(), ErrorStream::kBurstBytes);
  EXPECT_GE(flood.size(), ErrorStream::kBurstBytes / 2);
  now_ += std::chrono::milliseconds(20);
  stream_.Write("one that would fit");
  EXPECT_EQ(Read(), "") << "a little room is kept until there is more";
  now_ += std::chrono::seconds(60);
  stream_.Write("another");
  const std::string after = Read();
  EXPECT_NE(after.find(" lines were lost"), std::string::npos);
  EXPECT_TRUE(after.ends_with("\nagent_manager: another\n")) << after;
}

TEST_F(ErrorStreamTest, LinesWithinTheRateAreAllThere) {
  for (int i = 0; i < 1000; ++i) {
    now_ += std::chrono::seconds(1);
    stream_.Write(std::string(4000, 'x'));
    ASSERT_GT(Read().size(), 4000u) << i;
  }
}

TEST_F(ErrorStreamTest, AStderrNobodyReadsLosesLinesAndSaysSo) {
  ASSERT_EQ(fcntl(ends_[1], F_SETPIPE_SZ, 8192), 8192);
  for (int i = 0; i < 10; ++i) stream_.Write(std::string(4096, 'x'));  // a page each
  EXPECT_EQ(Read().size(), 8192u);
  stream_.Write("read again");
  const std::string after = Read();
  EXPECT_NE(after.find("8 lines were lost"), std::string::npos) << after;
  EXPECT_NE(after.find("read again"), std::string::npos) << after;
}

}  // namespace
