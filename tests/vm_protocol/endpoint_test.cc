#include "vm_protocol/runtime/endpoint.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <vector>

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
        [&](const std::string& reason) { heard.push_back("server: " + reason); });
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
        [](const std::string&) {});
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
  peer->Start([](Result<std::string_view>) {}, [&](const std::string& text) { reason = text; });
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

}  // namespace
}  // namespace vm
