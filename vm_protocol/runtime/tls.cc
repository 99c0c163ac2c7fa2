#include "vm_protocol/runtime/tls.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <stdexcept>
#include <utility>

#include "vm_protocol/core/text_file.h"
#include "vm_protocol/runtime/turns.h"

namespace vm {
namespace {

namespace asio = boost::asio;
namespace ssl = boost::asio::ssl;
using boost::system::error_code;

constexpr auto kTlsHandshakeLimit = std::chrono::seconds(10);
constexpr std::size_t kChunk = 16u * 1024;  // one TLS record

/// A connected socket whose input is only read in turn with that of others, until it is admitted:
/// what a handshake costs is spent when its input is read. An asynchronous stream for Asio.
class PacedSocket {
 public:
  using Socket = asio::generic::stream_protocol::socket;
  using lowest_layer_type = Socket::lowest_layer_type;
  using executor_type = Socket::executor_type;
  PacedSocket(Socket socket, std::shared_ptr<Turns> turns)
      : socket_(std::move(socket)), turns_(std::move(turns)) {}
  lowest_layer_type& lowest_layer() { return socket_.lowest_layer(); }
  executor_type get_executor() { return socket_.get_executor(); }
  void Admit() { turns_ = nullptr; }

  template <typename Buffers, typename Token>
  void async_read_some(const Buffers& buffers, Token&& token) {
    if (turns_ == nullptr) return socket_.async_read_some(buffers, std::forward<Token>(token));
    socket_.async_wait(Socket::wait_read, [this, buffers, token = std::forward<Token>(token)](
                                              const error_code& error) mutable {
      if (error) return std::move(token)(error, std::size_t{0});
      turns_->Wait([this, buffers, token = std::move(token)](const error_code&) mutable {
        if (HasEnded()) return std::move(token)(asio::error::eof, std::size_t{0});
        socket_.async_read_some(buffers, std::move(token));
      });
    });
  }
  template <typename Buffers, typename Token>
  void async_write_some(const Buffers& buffers, Token&& token) {
    socket_.async_write_some(buffers, std::forward<Token>(token));
  }

 private:
  /// Nothing is spent on those who have gone, or were shut out, while they waited.
  bool HasEnded() {
    pollfd state{socket_.native_handle(), POLLRDHUP, 0};
    return poll(&state, 1, 0) == 1 && (state.revents & (POLLRDHUP | POLLHUP)) != 0;
  }

  Socket socket_;
  std::shared_ptr<Turns> turns_;
};

/// A TLS stream on one side, one end of a local pair of sockets on the other, and bytes between
/// them. Kept alive by its operations; both ends close together. Reads only what has been passed
/// on, so a slow reader is felt at the far end as on a plain socket.
class Tunnel : public std::enable_shared_from_this<Tunnel> {
 public:
  Tunnel(asio::io_context& io, std::shared_ptr<ssl::context> context, PacedSocket socket,
         std::chrono::milliseconds close_limit)
      : context_(std::move(context)),
        remote_(std::move(socket), *context_),
        local_(io),
        limit_(io),
        close_limit_(close_limit) {}

  void Start(bool listener, const std::string& host, Tls::Done done) {
    done_ = std::move(done);
    if (!listener) {
      SSL_set_tlsext_host_name(remote_.native_handle(), host.c_str());
      remote_.set_verify_callback(ssl::host_name_verification(host));
    }
    limit_.expires_after(kTlsHandshakeLimit);
    limit_.async_wait([self = shared_from_this()](const error_code& error) {
      // Not closed before Done was called: until then whoever called us may use the descriptor.
      error_code ignored;
      if (!error) self->remote_.lowest_layer().shutdown(asio::socket_base::shutdown_both, ignored);
    });
    remote_.async_handshake(listener ? ssl::stream_base::server : ssl::stream_base::client,
                            [self = shared_from_this()](const error_code& error) {
                              self->limit_.cancel();
                              self->OnHandshake(error);
                            });
  }

 private:
  void OnHandshake(const error_code& error) {
    const Tls::Done done = std::exchange(done_, nullptr);
    std::array<int, 2> ends{-1, -1};
    if (error) {
      CloseRemote();
      return done(Fail(Errc::kAccess, "no TLS agreement: " + error.message()));
    }
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      CloseRemote();
      return done(Fail(Errc::kUnavailable, "cannot make a pair of sockets"));
    }
    local_.assign(asio::local::stream_protocol(), ends[0]);
    remote_.next_layer().Admit();
    FromRemote();
    FromLocal();
    // Also noticed while the far side takes nothing, when nobody reads from our side.
    local_.async_wait(asio::socket_base::wait_error,
                      [self = shared_from_this()](const error_code& stopped) {
                        if (!stopped) self->CloseRemoteInTime();
                      });
    done(Tls::Plain{ends[1], NameOfOther()});
  }

  std::string NameOfOther() {
    X509* const certificate = SSL_get1_peer_certificate(remote_.native_handle());
    if (certificate == nullptr) return "";
    std::array<char, 256> name{};
    X509_NAME_get_text_by_NID(X509_get_subject_name(certificate), NID_commonName, name.data(),
                              static_cast<int>(name.size()));
    X509_free(certificate);
    return name.data();
  }

  void FromRemote() {
    remote_.async_read_some(asio::buffer(inward_),
                            [self = shared_from_this()](const error_code& error, std::size_t n) {
                              if (error) return self->EndLocal();
                              asio::async_write(self->local_, asio::buffer(self->inward_, n),
                                                [self](const error_code& failed, std::size_t) {
                                                  failed ? self->CloseRemote() : self->FromRemote();
                                                });
                            });
  }
  void FromLocal() {
    local_.async_read_some(asio::buffer(outward_),
                           [self = shared_from_this()](const error_code& error, std::size_t n) {
                             if (error) return self->EndRemote();
                             asio::async_write(self->remote_, asio::buffer(self->outward_, n),
                                               [self](const error_code& failed, std::size_t) {
                                                 failed ? self->EndLocal() : self->FromLocal();
                                               });
                           });
  }
  /// The far side has ended: our side hears the end once it has read what came before.
  void EndLocal() {
    error_code ignored;
    local_.shutdown(asio::socket_base::shutdown_send, ignored);
    CloseRemote();
  }
  /// Our side has closed: the far side is told so.
  void EndRemote() {
    CloseRemoteInTime();
    remote_.async_shutdown([self = shared_from_this()](const error_code&) {
      self->limit_.cancel();
      self->CloseRemote();
    });
  }
  /// The far side has so long to take what is left.
  void CloseRemoteInTime() {
    if (!remote_.lowest_layer().is_open()) return;
    limit_.expires_after(close_limit_);
    limit_.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error) self->CloseRemote();
    });
  }
  void CloseRemote() {
    error_code ignored;
    remote_.lowest_layer().close(ignored);
  }

  std::shared_ptr<ssl::context> context_;
  ssl::stream<PacedSocket> remote_;
  asio::local::stream_protocol::socket local_;
  asio::steady_timer limit_;
  const std::chrono::milliseconds close_limit_;
  Tls::Done done_;
  std::array<char, kChunk> inward_{}, outward_{};
};

/// OpenSSL would wait for somebody to write into a named pipe. Throws std::runtime_error.
void CheckFile(const std::string& path) {
  constexpr std::size_t kMaxBytes = 4U << 20;
  if (path.empty()) return;
  if (const auto text = ReadTextFile(path, kMaxBytes); !text)
    throw std::runtime_error(text.error().text);
}

class TlsImpl final : public Tls {
 public:
  TlsImpl(const Credentials& credentials, bool listener, std::chrono::milliseconds close_limit)
      : context_(std::make_shared<ssl::context>(listener ? ssl::context::tls_server
                                                         : ssl::context::tls_client)),
        close_limit_(close_limit),
        listener_(listener) {
    SSL_CTX_set_min_proto_version(context_->native_handle(), TLS1_2_VERSION);
    try {
      for (const std::string& file :
           {credentials.certificate, credentials.key, credentials.authority})
        CheckFile(file);
      what_ = "the certificate '" + credentials.certificate + "'";
      if (!credentials.certificate.empty())
        context_->use_certificate_chain_file(credentials.certificate);
      what_ = "the key '" + credentials.key + "'";
      if (!credentials.key.empty())
        context_->use_private_key_file(credentials.key, ssl::context::pem);
      what_ = "the authority '" + credentials.authority + "'";
      if (!credentials.authority.empty()) {
        context_->load_verify_file(credentials.authority);
      } else if (!listener) {
        context_->set_default_verify_paths();
      }
    } catch (const boost::system::system_error& error) {
      throw std::runtime_error("cannot use " + what_ + ": " + error.code().message());
    }
    const bool verifies = !listener || !credentials.authority.empty();
    context_->set_verify_mode(verifies ? ssl::verify_peer | ssl::verify_fail_if_no_peer_cert
                                       : ssl::verify_none);
  }

  void Wrap(asio::io_context& io, int fd, const std::string& host, Done done) override {
    sockaddr_storage address{};
    socklen_t size = sizeof(address);
    getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
    PacedSocket::Socket socket(io);
    error_code error;
    socket.assign(asio::generic::stream_protocol(address.ss_family, 0), fd, error);
    if (error) {
      close(fd);
      return done(Fail(Errc::kUnavailable, error.message()));
    }
    if (turns_ == nullptr) turns_ = std::make_shared<Turns>(io);
    std::make_shared<Tunnel>(io, context_, PacedSocket(std::move(socket), turns_), close_limit_)
        ->Start(listener_, host, done);
  }

 private:
  std::shared_ptr<ssl::context> context_;
  std::shared_ptr<Turns> turns_;  // of those who have not agreed yet
  const std::chrono::milliseconds close_limit_;
  const bool listener_;
  std::string what_;
};

}  // namespace

std::shared_ptr<Tls> Tls::ForListener(const Credentials& credentials,
                                      std::chrono::milliseconds close_limit) {
  return std::make_shared<TlsImpl>(credentials, true, close_limit);
}
std::shared_ptr<Tls> Tls::ForCaller(const Credentials& credentials,
                                    std::chrono::milliseconds close_limit) {
  return std::make_shared<TlsImpl>(credentials, false, close_limit);
}

}  // namespace vm
