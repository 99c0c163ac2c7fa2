#include "ssm/sinks/copying_sink.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <sstream>

#include "tests/support/process.h"

namespace ssm {
namespace {

constexpr std::size_t kTenthOfASecond = 1600;

std::shared_ptr<SampleBuffer> Steps(std::size_t frames) {
  std::vector<std::int16_t> samples(frames);
  for (std::size_t i = 0; i < frames; ++i) samples[i] = static_cast<std::int16_t>(i + 1);
  auto buffer = std::make_shared<SampleBuffer>(frames);
  buffer->Append(samples);
  return buffer;
}

/// Somebody who listens at a socket and takes the records apart.
class Listener {
 public:
  explicit Listener(const std::string& path) : fd_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, path.size());
    EXPECT_EQ(bind(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(fd_, 4), 0);
    fcntl(fd_, F_SETFL, O_NONBLOCK);
  }
  ~Listener() {
    Close();
    close(fd_);
  }
  void Close() {
    if (peer_ >= 0) close(peer_);
    peer_ = -1;
  }
  /// The heads of the records that have come since the last call, with a bar between; the samples
  /// go to `samples`.
  std::string Heads() {
    if (peer_ < 0) peer_ = accept(fd_, nullptr, nullptr);
    std::string text(1 << 20, '\0');
    const ssize_t n = recv(peer_, text.data(), text.size(), MSG_DONTWAIT);
    text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    bytes += text.size();
    std::string heads;
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      if (end == std::string::npos) return heads + "?";
      const std::string head = text.substr(0, end);
      text.erase(0, end + 1);
      heads += (heads.empty() ? "" : "|") + head;
      std::istringstream words(head);
      std::string kind, at, rate;
      std::size_t size = 0;
      words >> kind >> at >> rate >> size;
      for (std::size_t i = 0; i + 1 < size && i + 1 < text.size(); i += 2) {
        samples.push_back(static_cast<std::int16_t>(static_cast<unsigned char>(text[i]) |
                                                    static_cast<unsigned char>(text[i + 1]) << 8));
      }
      text.erase(0, size);
    }
    return heads;
  }
  std::vector<std::int16_t> samples;
  std::size_t bytes = 0;

 private:
  int fd_, peer_ = -1;
};

class CopyingSinkTest : public testing::Test {
 protected:
  support::TempDir folder_;
  const std::string path_ = folder_ / "sound";
  vm::VirtualScheduler clock_;
  CopyingSink sink_{clock_, std::make_unique<ClockSink>(clock_)};
};

TEST_F(CopyingSinkTest, SamplesComeWithTheirTimesBeforeTheyAreHeard) {
  Listener listener(path_);
  ASSERT_TRUE(sink_.SendTo("unix:" + path_));
  EXPECT_EQ(sink_.to(), "unix:" + path_);
  ASSERT_TRUE(sink_.Play(Steps(5 * kTenthOfASecond), vm::Time(100'000)));
  // 300 of the 400 ms ahead are left after the start.
  EXPECT_EQ(listener.Heads(), "sound 100 16000 9600");
  clock_.RunUntil(vm::Time(80'000));
  EXPECT_EQ(listener.Heads(), "sound 400 16000 1280|sound 440 16000 1280");
  clock_.RunUntil(vm::Time(600'000));
  EXPECT_EQ(listener.Heads(), "sound 480 16000 1280|sound 520 16000 1280|sound 560 16000 1280");
  EXPECT_EQ(sink_.Stop().frames, 5 * kTenthOfASecond);
  EXPECT_EQ(listener.Heads(), "end 600");
  ASSERT_EQ(listener.samples.size(), 5 * kTenthOfASecond);
  for (std::size_t i = 0; i < listener.samples.size(); ++i)
    ASSERT_EQ(listener.samples[i], static_cast<std::int16_t>(i + 1)) << i;
}

TEST_F(CopyingSinkTest, AStopSaysFromWhenOnNothingIsHeard) {
  Listener listener(path_);
  ASSERT_TRUE(sink_.SendTo("unix:" + path_));
  ASSERT_TRUE(sink_.Play(Steps(5 * kTenthOfASecond), vm::Time(0)));
  clock_.RunUntil(vm::Time(50'000));
  listener.Heads();
  EXPECT_EQ(sink_.Stop().frames, 800u);
  EXPECT_NE(listener.Heads().find("end 50"), std::string::npos);
}

TEST_F(CopyingSinkTest, WhatIsMadeTooLateIsSilence) {
  Listener listener(path_);
  ASSERT_TRUE(sink_.SendTo("unix:" + path_));
  auto late = std::make_shared<SampleBuffer>(kTenthOfASecond);
  ASSERT_TRUE(sink_.Play(late, vm::Time(0)));
  clock_.RunUntil(vm::Time(41'000));
  EXPECT_EQ(listener.Heads(), "");
  late->Append(std::vector<std::int16_t>(kTenthOfASecond, 7));
  clock_.RunUntil(vm::Time(80'000));
  EXPECT_EQ(listener.Heads(), "sound 80 16000 640");
  sink_.Stop();
}

TEST_F(CopyingSinkTest, WhoComesInTheMiddleHearsTheRest) {
  Listener listener(path_);
  ASSERT_TRUE(sink_.Play(Steps(5 * kTenthOfASecond), vm::Time(0)));
  clock_.RunUntil(vm::Time(200'000));
  ASSERT_TRUE(sink_.SendTo("unix:" + path_));
  EXPECT_EQ(listener.Heads(), "sound 200 16000 9600");
  EXPECT_EQ(listener.samples.at(0), 3201);
  sink_.Stop();
}

TEST_F(CopyingSinkTest, OneWhoHasGoneIsForgotten) {
  Listener listener(path_);
  ASSERT_TRUE(sink_.SendTo("unix:" + path_));
  listener.Heads();
  listener.Close();
  EXPECT_EQ(sink_.to(), "NONE");
  ASSERT_TRUE(sink_.Play(Steps(kTenthOfASecond), vm::Time(0)));
  clock_.RunUntil(vm::Time(100'000));
  EXPECT_EQ(sink_.Stop().frames, kTenthOfASecond) << "the sound itself goes on";
}

TEST_F(CopyingSinkTest, OneWhoTakesNothingHoldsNobodyAndIsCutOff) {
  Listener listener(path_);
  ASSERT_TRUE(sink_.SendTo("unix:" + path_));
  // More than the system keeps for a socket and what may wait here: 60 s are 1.9 MB.
  const auto minute = Steps(600 * kTenthOfASecond);
  ASSERT_TRUE(sink_.Play(minute, vm::Time(0)));
  clock_.RunUntil(vm::Time(60'000'000));
  EXPECT_EQ(sink_.Stop().frames, minute->size());
  EXPECT_EQ(sink_.to(), "NONE");
  listener.Heads();
  EXPECT_LT(listener.bytes, minute->size() * 2);
}

TEST_F(CopyingSinkTest, OtherPlacesAreRefusedWithASentence) {
  EXPECT_EQ(sink_.SendTo("tcp:80").error().code, vm::Errc::kBadValue);
  EXPECT_EQ(sink_.SendTo("unix:" + (folder_ / "nobody")).error().code, vm::Errc::kUnavailable);
  EXPECT_EQ(sink_.SendTo("unix:" + std::string(300, 'x')).error().code, vm::Errc::kUnavailable);
  EXPECT_EQ(sink_.SendTo("unix:").error().code, vm::Errc::kUnavailable);
  EXPECT_EQ(sink_.to(), "NONE");
}

}  // namespace
}  // namespace ssm
