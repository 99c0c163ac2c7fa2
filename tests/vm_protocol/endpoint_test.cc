#include "vm_protocol/runtime/endpoint.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/sanitized.h"
#include "vm_protocol/runtime/acceptor.h"
#include "vm_protocol/runtime/tls.h"

namespace vm {
namespace {

TEST(EndpointTest, ReadsAndWritesBothKinds) {
  for (const auto* text : {"unix:/tmp/a b.sock", "tcp:localhost:10600", "tcp:[::1]:5", "tls:h:5"}) {
    const auto endpoint = ParseEndpoint(text);
    ASSERT_TRUE(endpoint) << text;
    EXPECT_EQ(FormatEndpoint(*endpoint), text);
  }
  for (const auto* text :
       {"", "unix:", "tcp:host", "tcp::5", "tcp:h:70000", "tcp:h:5x", "udp:h:5", "h:5"}) {
    EXPECT_FALSE(ParseEndpoint(text)) << text;
  }
  EXPECT_FALSE(ParseEndpoint("unix:/" + std::string(200, 'x')));
}

class ListenerTest : public testing::TestWithParam<const char*> {
 protected:
  ListenerTest() {
    std::string pattern = testing::TempDir() + "galatea-XXXXXX";
    folder_ = mkdtemp(pattern.data());
  }
  ~ListenerTest() override { rmdir(folder_.c_str()); }
  Endpoint Where() const {
    return *ParseEndpoint(std::string(GetParam()) == "unix" ? "unix:" + folder_ + "/s"
                                                            : "tcp:127.0.0.1:0");
  }
  std::string folder_;
  boost::asio::io_context io_;
};

TEST_P(ListenerTest, LinesGoBothWays) {
  std::shared_ptr<StreamPeer> server_side;
  std::vector<std::string> heard;
  const auto listener = Listener::Open(io_, Where(), [&](int fd, const std::string&) {
    server_side = StreamPeer::Make(io_, fd, fd, Framing::kLf);
    server_side->Start(
        [&](Result<std::string_view> line) { server_side->Send("echo " + std::string(*line)); },
        [&](const StreamEnd& end) { heard.push_back("server: " + end.reason); });
  });
  std::shared_ptr<StreamPeer> client_side;
  ConnectTo(io_, listener->endpoint(), [&](Result<int> fd) {
    ASSERT_TRUE(fd) << fd.error().text;
    client_side = StreamPeer::Make(io_, *fd, *fd, Framing::kLf);
    client_side->Start(
        [&](Result<std::string_view> line) {
          heard.emplace_back(*line);
          if (heard.size() == 2) client_side->Close();
        },
        [](const StreamEnd&) {});
    client_side->Send("one");
    client_side->Send("two");
  });
  while (heard.size() < 3) io_.run_one();
  EXPECT_EQ(heard, (std::vector<std::string>{"echo one", "echo two", "server: end of input"}));
  server_side->Close();
}

INSTANTIATE_TEST_SUITE_P(Kinds, ListenerTest, testing::Values("unix", "tcp"));

TEST(UnixListenerTest, TheSocketIsPrivateTakenOnceAndRemovedAtTheEnd) {
  std::string pattern = testing::TempDir() + "galatea-XXXXXX";
  const std::string folder = mkdtemp(pattern.data());
  const Endpoint where{Endpoint::Kind::kUnix, folder + "/s", 0};
  boost::asio::io_context io;
  {
    const auto listener = Listener::Open(io, where, [](int fd, const std::string&) { close(fd); });
    struct stat info {};
    ASSERT_EQ(stat(where.host.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0600u);
    EXPECT_THROW(Listener::Open(io, where, [](int, const std::string&) {}), std::runtime_error);
  }
  EXPECT_NE(access(where.host.c_str(), F_OK), 0);
  rmdir(folder.c_str());
}

TEST(ConnectTest, NobodyThereIsAnErrorThatNamesThePlace) {
  boost::asio::io_context io;
  std::string text;
  ConnectTo(io, {Endpoint::Kind::kUnix, "/nonexistent/socket", 0},
            [&](Result<int> fd) { text = fd ? "connected" : fd.error().text; });
  io.run();
  EXPECT_NE(text.find("/nonexistent/socket"), std::string::npos) << text;
}

TEST(StreamPeerTest, AReaderThatDoesNotReadIsCutOffAtTheLimit) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  int input[2];
  ASSERT_EQ(pipe(input), 0);
  boost::asio::io_context io;
  const auto peer = StreamPeer::Make(io, input[0], ends[1], Framing::kLf);
  std::string reason;
  peer->Start([](Result<std::string_view>) {}, [&](const StreamEnd& end) { reason = end.reason; });
  const std::string line(60000, 'x');
  while (reason.empty()) {
    peer->Send(line);
    io.poll();
    ASSERT_LE(peer->backlog_bytes(), kMaxBacklogBytes + line.size() + 1);
  }
  EXPECT_NE(reason.find("too slow"), std::string::npos) << reason;
  peer->Close();
  close(ends[0]);
  close(input[1]);
}

TEST(StreamPeerTest, ALineCutOffByAResetIsNotHeard) {
  boost::asio::io_context io;
  std::shared_ptr<StreamPeer> server;
  std::vector<std::string> heard;
  std::string reason;
  const auto listener =
      Listener::Open(io, *ParseEndpoint("tcp:127.0.0.1:0"), [&](int fd, const std::string&) {
        server = StreamPeer::Make(io, fd, fd, Framing::kLf);
        server->Start([&](Result<std::string_view> line) { heard.emplace_back(*line); },
                      [&](const StreamEnd& end) { reason = end.reason; });
      });
  int client = -1;
  ConnectTo(io, listener->endpoint(), [&](Result<int> fd) { client = fd.value_or(-1); });
  while (client < 0 || !server) io.run_one();
  constexpr std::string_view kWhole = "whole\n", kCut = "set Run = EXIT";
  ASSERT_EQ(write(client, kWhole.data(), kWhole.size()), 6);
  while (heard.empty()) io.run_one();
  ASSERT_EQ(write(client, kCut.data(), kCut.size()), 14);
  const linger reset{.l_onoff = 1, .l_linger = 0};
  setsockopt(client, SOL_SOCKET, SO_LINGER, &reset, sizeof(reset));
  close(client);
  while (reason.empty()) io.run_one();
  EXPECT_EQ(heard, std::vector<std::string>{"whole"});
  EXPECT_NE(reason.find("reset"), std::string::npos) << reason;
  server->Close();
}

TEST(ListenerTroubleTest, RunningOutOfDescriptorsIsSaidOnceAndPasses) {
  if (support::kSanitized) GTEST_SKIP() << "the sanitizers need descriptors of their own";
  const support::TempDir folder;
  boost::asio::io_context io;
  std::vector<std::string> troubles;
  int accepted = 0;
  const auto listener = Listener::Open(
      io, {Endpoint::Kind::kUnix, folder / "s", 0},
      [&](int fd, const std::string&) {
        ++accepted;
        close(fd);
      },
      [&](const std::string& text) { troubles.push_back(text); });
  const auto client = support::SocketClient::Unix(folder / "s");
  rlimit old{};
  getrlimit(RLIMIT_NOFILE, &old);
  const rlimit none{.rlim_cur = 3, .rlim_max = old.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
  std::size_t turns = 0;
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
  while (std::chrono::steady_clock::now() < until) turns += io.run_one_until(until);
  setrlimit(RLIMIT_NOFILE, &old);
  ASSERT_EQ(troubles.size(), 1u);
  EXPECT_NE(troubles[0].find("cannot accept: Too many open files"), std::string::npos);
  EXPECT_LT(turns, 20u) << "it does not spin";
  while (accepted == 0) io.run_one();
  EXPECT_EQ(accepted, 1);
}

TEST(CredentialsTest, NamedPipesAreRefusedAndNotWaitedFor) {
  const support::TempDir folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const auto token = ReadToken({.token_file = pipe, .certificate = "", .key = "", .authority = ""});
  ASSERT_FALSE(token);
  EXPECT_NE(token.error().text.find(pipe), std::string::npos) << token.error().text;
  boost::asio::io_context io;
  for (const Credentials& credentials :
       {Credentials{.token_file = "", .certificate = pipe, .key = pipe, .authority = ""},
        Credentials{.token_file = "", .certificate = "", .key = "", .authority = pipe}}) {
    EXPECT_THROW(Tls::ForListener(credentials), std::runtime_error);
  }
}

TEST(AcceptorTest, SilentStrangersDoNotLockOutWhoHasTheToken) {
  const support::TempDir folder;
  std::ofstream(folder / "token") << "0123456789abcdef\n";
  ASSERT_EQ(chmod((folder / "token").c_str(), 0600), 0);
  const Credentials credentials{
      .token_file = folder / "token", .certificate = "", .key = "", .authority = ""};
  boost::asio::io_context io;
  std::vector<std::shared_ptr<StreamPeer>> admitted;
  std::size_t refused = 0;
  const auto acceptor = Acceptor::Open(
      io, {Endpoint::Kind::kUnix, folder / "s", 0}, credentials, Framing::kLf, Encoding::kUtf8,
      [&](const Acceptor::Connection& connection) { admitted.push_back(connection.stream); },
      [&](const std::string&) { ++refused; });
  std::vector<std::unique_ptr<support::SocketClient>> strangers;
  for (std::size_t i = 0; i < 2 * Acceptor::kMaxUnadmitted; ++i) {
    strangers.push_back(support::SocketClient::Unix(folder / "s"));
    io.poll();
  }
  std::shared_ptr<StreamPeer> caller;
  Connect(io, acceptor->endpoint(), credentials, Framing::kLf, Encoding::kUtf8,
          [&](const Result<std::shared_ptr<StreamPeer>>& called) {
            ASSERT_TRUE(called) << called.error().text;
            caller = *called;
          });
  while (!caller || admitted.empty()) io.run_one();
  EXPECT_GE(refused, Acceptor::kMaxUnadmitted);
  caller->Close();
  admitted[0]->Close();
}

TEST(ConnectTest, ANameIsResolvedWithoutBlockingAndAllItsAddressesAreTried) {
  boost::asio::io_context io;
  const auto listener = Listener::Open(io, *ParseEndpoint("tcp:127.0.0.1:0"),
                                       [](int fd, const std::string&) { close(fd); });
  Endpoint where = listener->endpoint();
  where.host = "localhost";  // ::1 first, on many machines
  int connected = -1;
  ConnectTo(io, where, [&](const Result<int>& fd) {
    ASSERT_TRUE(fd) << fd.error().text;
    connected = *fd;
  });
  EXPECT_EQ(connected, -1);
  while (connected < 0) io.run_one();
  close(connected);
}

}  // namespace
}  // namespace vm
