#include "vm_protocol/runtime/tls.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/certificates.h"
#include "tests/support/process.h"
#include "vm_protocol/runtime/turns.h"

namespace {

using std::chrono::milliseconds;
using vm::Tls;

/// Two ends that have agreed, within one program.
class TlsTest : public testing::Test {
 protected:
  TlsTest() : certificates_(folder_.path()) {
    certificates_.Sign("hub");
    vm::Credentials ours, theirs;
    ours.certificate = certificates_.Certificate("hub");
    ours.key = certificates_.Key("hub");
    theirs.authority = certificates_.Certificate("ca");
    std::array<int, 2> wire{-1, -1};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, wire.data()), 0);
    wire_ = dup(wire[1]);
    listener_ = Tls::ForListener(ours, milliseconds(50));
    caller_ = Tls::ForCaller(theirs);
    listener_->Wrap(io_, wire[0], "", [this](vm::Result<Tls::Plain> plain) {
      if (plain) near_ = plain->fd;
    });
    caller_->Wrap(io_, wire[1], "127.0.0.1", [this](vm::Result<Tls::Plain> plain) {
      if (plain) far_ = plain->fd;
    });
    Run([this] { return near_ >= 0 && far_ >= 0; });
  }
  ~TlsTest() override {
    for (const int fd : {near_, far_, wire_}) {
      if (fd >= 0) close(fd);
    }
  }
  template <typename Until>
  bool Run(const Until& until) {
    const auto deadline = std::chrono::steady_clock::now() + support::kPatience;
    while (!until() && std::chrono::steady_clock::now() < deadline)
      io_.run_one_for(milliseconds(20));
    return until();
  }
  /// Whether the descriptor hears of the end of the connection.
  static bool Ended(int fd) {
    std::array<char, 65536> bytes;
    while (true) {
      const ssize_t n = recv(fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (n <= 0) return n == 0;
    }
  }

  support::TempDir folder_;
  support::Certificates certificates_;
  boost::asio::io_context io_;
  std::shared_ptr<Tls> listener_, caller_;
  int near_ = -1, far_ = -1;
  int wire_ = -1;  // what the far end is connected by
};

TEST_F(TlsTest, WhatIsSaidBeforeTheEndArrives) {
  ASSERT_EQ(write(near_, "last\n", 5), 5);
  close(std::exchange(near_, -1));
  std::array<char, 16> bytes{};
  EXPECT_TRUE(Run([&] { return recv(far_, bytes.data(), 5, MSG_DONTWAIT | MSG_PEEK) == 5; }));
  EXPECT_TRUE(Run([&] { return Ended(far_); }));
}

TEST_F(TlsTest, OneThatTakesNothingIsLetGoOnceOurEndIsClosed) {
  const std::vector<char> much(65536, 'x');
  int full = 0;
  while (full < 5) {  // nobody reads at the far end: all buffers between us fill
    full = send(near_, much.data(), much.size(), MSG_DONTWAIT) > 0 ? 0 : full + 1;
    io_.run_for(milliseconds(1));
  }
  close(std::exchange(near_, -1));
  EXPECT_TRUE(Run([this] {
    pollfd wire{wire_, 0, 0};
    return poll(&wire, 1, 0) == 1 && (wire.revents & POLLHUP) != 0;
  }));
}

TEST(TurnsTest, OneGoesInEachRoundAndOthersComeInBetween) {
  boost::asio::io_context io;
  const auto turns = std::make_shared<vm::Turns>(io);
  std::string order;
  for (int i = 0; i < 5; ++i) {
    turns->Wait([&order](const auto&) { order += 'w'; });
  }
  const std::function<void()> other = [&] {
    order += '.';
    if (order.size() < 20) boost::asio::post(io, other);
  };
  boost::asio::post(io, other);
  io.run();
  EXPECT_EQ(order.find("ww"), std::string::npos) << order;
  EXPECT_EQ(std::count(order.begin(), order.end(), 'w'), 5) << order;
  turns->Wait([&order](const auto&) { order += "again"; });
  io.restart();
  io.run();
  EXPECT_TRUE(order.ends_with("again")) << order;
}

}  // namespace
