#include "vm_protocol/runtime/endpoint.h"

#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <charconv>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>

namespace vm {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using asio::local::stream_protocol;
using boost::system::error_code;

constexpr auto kAcceptPause = std::chrono::milliseconds(200);
constexpr auto kTroubleOver = std::chrono::seconds(10);  // without any; the next is told of again

std::unexpected<Error> BadEndpoint(std::string_view text) {
  return Fail(Errc::kBadValue, "found '" + std::string(text) +
                                   "', expected unix:PATH, tcp:HOST:PORT or tls:HOST:PORT");
}

void NoDelay(int fd) {
  const int on = 1;
  setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
}

tcp::endpoint ResolveTcp(asio::io_context& io, const Endpoint& endpoint, error_code& error) {
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(endpoint.host, std::to_string(endpoint.port), error);
  return error || found.empty() ? tcp::endpoint() : found.begin()->endpoint();
}

template <typename Protocol>
class ListenerImpl final : public Listener {
 public:
  ListenerImpl(asio::io_context& io, const typename Protocol::endpoint& where, Endpoint endpoint,
               OnAccept on_accept, OnTrouble on_trouble)
      : acceptor_(io),
        pause_(io),
        endpoint_(std::move(endpoint)),
        on_accept_(std::move(on_accept)),
        on_trouble_(std::move(on_trouble)) {
    acceptor_.open(where.protocol());
    if constexpr (std::is_same_v<Protocol, tcp>)
      acceptor_.set_option(tcp::acceptor::reuse_address(true));
    // The socket's file is born private: nobody can slip in between bind and chmod.
    const mode_t old_mask = umask(0177);
    error_code error;
    acceptor_.bind(where, error);
    umask(old_mask);
    if (error) throw boost::system::system_error(error);
    acceptor_.listen();
    fcntl(acceptor_.native_handle(), F_SETFD, FD_CLOEXEC);
    if constexpr (std::is_same_v<Protocol, tcp>) endpoint_.port = acceptor_.local_endpoint().port();
    AcceptNext();
  }
  ~ListenerImpl() override {
    if (spare_ >= 0) close(spare_);
    if (endpoint_.kind == Endpoint::Kind::kUnix) unlink(endpoint_.host.c_str());
  }
  Endpoint endpoint() const override { return endpoint_; }

 private:
  void AcceptNext() {
    acceptor_.async_accept([this, alive = std::weak_ptr(alive_)](const error_code& error,
                                                                 typename Protocol::socket socket) {
      if (alive.expired()) return;  // it had been accepted before, and is closed
      if (error == asio::error::operation_aborted) return;
      if (error == asio::error::no_descriptors && spare_ >= 0) return TurnAway(error);
      if (error && error != asio::error::connection_aborted) return Pause(error);
      if (!error) {
        if constexpr (std::is_same_v<Protocol, tcp>) NoDelay(socket.native_handle());
        fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
        on_accept_(socket.release(), FormatEndpoint(endpoint_));
      }
      AcceptNext();
    });
  }

  /// With the descriptor kept for it the one who came is accepted and let go: it hears that it is
  /// refused, and does not wait.
  void TurnAway(const error_code& error) {
    close(std::exchange(spare_, -1));
    const int fd = accept(acceptor_.native_handle(), nullptr, nullptr);
    if (fd >= 0) close(fd);
    spare_ = open("/dev/null", O_RDONLY | O_CLOEXEC);
    // None may be waiting; the system says that it has no descriptor all the same.
    if (fd < 0) return Pause(error);
    Tell(error);
    AcceptNext();
  }

  void Tell(const error_code& error) {
    const auto now = std::chrono::steady_clock::now();
    const auto before = std::exchange(trouble_at_, now);
    if (on_trouble_ && (!before || now - *before > kTroubleOver))
      on_trouble_(FormatEndpoint(endpoint_) + ": cannot accept: " + error.message());
  }

  /// Trying again at once would spin: the connection stays in the system's queue.
  void Pause(const error_code& error) {
    Tell(error);
    pause_.expires_after(kAcceptPause);
    pause_.async_wait([this, alive = std::weak_ptr(alive_)](const error_code& cancelled) {
      if (!cancelled && !alive.expired()) AcceptNext();
    });
  }

  typename Protocol::acceptor acceptor_;
  asio::steady_timer pause_;
  Endpoint endpoint_;
  OnAccept on_accept_;
  OnTrouble on_trouble_;
  const std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
  std::optional<std::chrono::steady_clock::time_point> trouble_at_;  // the last, told of or not
  int spare_ = open("/dev/null", O_RDONLY | O_CLOEXEC);
};

/// Removes the file of a Unix socket nobody listens on any more.
void RemoveStale(asio::io_context& io, const std::string& path) {
  struct stat info {};
  if (lstat(path.c_str(), &info) != 0) return;
  if (!S_ISSOCK(info.st_mode))
    throw std::runtime_error("'" + path + "' exists and is not a socket");
  stream_protocol::socket probe(io);
  error_code error;
  probe.connect(stream_protocol::endpoint(path), error);
  if (!error) throw std::runtime_error("somebody is already listening on '" + path + "'");
  unlink(path.c_str());
}

/// Tries all of `places` in order.
template <typename Protocol, typename Places>
void Connect(asio::io_context& io, const Places& places, const Endpoint& endpoint,
             std::function<void(Result<int>)> done) {
  auto socket = std::make_shared<typename Protocol::socket>(io);
  asio::async_connect(
      *socket, places,
      [socket, endpoint, done = std::move(done)](const error_code& error, const auto&) {
        if (error) {
          done(Fail(Errc::kUnavailable,
                    "cannot connect to " + FormatEndpoint(endpoint) + ": " + error.message()));
          return;
        }
        if constexpr (std::is_same_v<Protocol, tcp>) NoDelay(socket->native_handle());
        fcntl(socket->native_handle(), F_SETFD, FD_CLOEXEC);
        done(socket->release());
      });
}

constexpr std::size_t kMaxUnixPath = sizeof(sockaddr_un::sun_path) - 1;

}  // namespace

Result<Endpoint> ParseEndpoint(std::string_view text) {
  if (text.starts_with("unix:")) {
    const std::string_view path = text.substr(5);
    if (path.empty() || path.size() > kMaxUnixPath) return BadEndpoint(text);
    return Endpoint{Endpoint::Kind::kUnix, std::string(path), 0};
  }
  const bool tls = text.starts_with("tls:");
  if (!tls && !text.starts_with("tcp:")) return BadEndpoint(text);
  std::string_view rest = text.substr(4);
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string_view::npos || colon == 0) return BadEndpoint(text);
  const std::string_view port_text = rest.substr(colon + 1);
  std::string_view host = rest.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  unsigned port = 0;
  const auto [end, error] =
      std::from_chars(port_text.data(), port_text.data() + port_text.size(), port);
  if (error != std::errc() || end != port_text.data() + port_text.size() || port > 65535) {
    return BadEndpoint(text);
  }
  return Endpoint{tls ? Endpoint::Kind::kTls : Endpoint::Kind::kTcp, std::string(host),
                  static_cast<unsigned short>(port)};
}

std::string FormatEndpoint(const Endpoint& endpoint) {
  if (endpoint.kind == Endpoint::Kind::kUnix) return "unix:" + endpoint.host;
  const bool v6 = endpoint.host.find(':') != std::string::npos;
  return (endpoint.kind == Endpoint::Kind::kTls ? "tls:" : "tcp:") +
         (v6 ? "[" + endpoint.host + "]" : endpoint.host) + ":" + std::to_string(endpoint.port);
}

std::unique_ptr<Listener> Listener::Open(asio::io_context& io, const Endpoint& endpoint,
                                         OnAccept on_accept, OnTrouble on_trouble) {
  try {
    if (endpoint.kind == Endpoint::Kind::kUnix) {
      RemoveStale(io, endpoint.host);
      return std::make_unique<ListenerImpl<stream_protocol>>(
          io, stream_protocol::endpoint(endpoint.host), endpoint, std::move(on_accept),
          std::move(on_trouble));
    }
    error_code error;
    const auto where = ResolveTcp(io, endpoint, error);
    if (error) throw boost::system::system_error(error);
    return std::make_unique<ListenerImpl<tcp>>(io, where, endpoint, std::move(on_accept),
                                               std::move(on_trouble));
  } catch (const boost::system::system_error& error) {
    throw std::runtime_error("cannot listen on " + FormatEndpoint(endpoint) + ": " +
                             error.code().message());
  }
}

void ConnectTo(asio::io_context& io, const Endpoint& endpoint,
               std::function<void(Result<int> fd)> done) {
  if (endpoint.kind == Endpoint::Kind::kUnix) {
    return Connect<stream_protocol>(io, std::array{stream_protocol::endpoint(endpoint.host)},
                                    endpoint, std::move(done));
  }
  const auto resolver = std::make_shared<tcp::resolver>(io);
  resolver->async_resolve(
      endpoint.host, std::to_string(endpoint.port),
      [&io, resolver, endpoint, done = std::move(done)](const error_code& error,
                                                        const tcp::resolver::results_type& found) {
        if (!error) return Connect<tcp>(io, found, endpoint, done);
        done(Fail(Errc::kUnavailable, "cannot find " + endpoint.host + ": " + error.message()));
      });
}

}  // namespace vm
