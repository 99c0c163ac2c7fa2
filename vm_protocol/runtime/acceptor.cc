#include "vm_protocol/runtime/acceptor.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "vm_protocol/core/message.h"

namespace vm {
namespace {

namespace asio = boost::asio;

constexpr auto kAdmissionLimit = std::chrono::seconds(10);
constexpr std::string_view kAsking = "Galatea 1.0 asks for the token, ";

/// Where a socket's other end is, for people.
std::string OtherEnd(int fd) {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (getpeername(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return "somebody";
  if (address.ss_family == AF_UNIX) return "this machine";
  std::array<char, NI_MAXHOST> host{};
  std::array<char, NI_MAXSERV> port{};
  getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host.data(), host.size(),
              port.data(), port.size(), NI_NUMERICHOST | NI_NUMERICSERV);
  return std::string(host.data()) + ":" + port.data();
}

/// One line each way before the stream belongs to somebody else. Kept alive by its timer until it
/// is done, once.
class Handshake : public std::enable_shared_from_this<Handshake> {
 public:
  using Done = std::function<void(Result<void>)>;
  Handshake(asio::io_context& io, std::shared_ptr<StreamPeer> stream, std::string token)
      : io_(io), stream_(std::move(stream)), token_(std::move(token)), limit_(io) {}

  void Admit(Done done) {
    Begin(std::move(done));
    stream_->Send("tell " + std::string(kAsking) + ours_);
    Listen([this](const std::string& line) { OnShown(line); });
  }
  void Show(Done done) {
    Begin(std::move(done));
    Listen([this](const std::string& line) { OnAsked(line); });
  }

 private:
  void Begin(Done done) {
    done_ = std::move(done);
    ours_ = MakeNonce();
    limit_.expires_after(kAdmissionLimit);
    limit_.async_wait([self = shared_from_this()](const auto& error) {
      if (!error) self->End(Fail(Errc::kAccess, "no token within the time"));
    });
  }
  void Listen(std::function<void(const std::string& line)> on_line) {
    on_line_ = std::move(on_line);
    stream_->Start(
        [weak = weak_from_this()](Result<std::string_view> line) {
          const auto self = weak.lock();
          if (self == nullptr || self->done_ == nullptr) return;
          if (!line) return self->End(std::unexpected(line.error()));
          const std::string text(*line);
          self->on_line_(text);
        },
        [weak = weak_from_this()](const StreamEnd& end) {
          if (const auto self = weak.lock())
            self->End(Fail(Errc::kAccess, "it left: " + end.reason));
        });
  }
  /// At the listener: `set#token Token = NONCE PROOF`.
  void OnShown(const std::string& line) {
    const auto message = ParseMessage(line);
    std::istringstream words(message ? message->value : "");
    std::string nonce, proof;
    words >> nonce >> proof;
    if (!message || message->command != Command::kSet || message->slot != "Token" ||
        nonce.size() != ours_.size())
      return Refuse("it does not show a token");
    if (!SameProof(proof, TokenProof(token_, "caller", ours_, nonce)))
      return Refuse("it shows a wrong token");
    stream_->Send("rep#token Token = " + TokenProof(token_, "listener", ours_, nonce));
    End({});
  }
  void Refuse(const std::string& why) {
    stream_->Send("rep#token Token.error = ACCESS refused");
    End(Fail(Errc::kAccess, why));
  }
  /// At the caller: the question, then the proof of the listener.
  void OnAsked(const std::string& line) {
    const auto message = ParseMessage(line);
    if (!message) return End(std::unexpected(message.error()));
    if (theirs_.empty()) {
      if (message->command != Command::kTell || !message->value.starts_with(kAsking))
        return End(Fail(Errc::kAccess, "it does not ask for the token"));
      theirs_ = message->value.substr(kAsking.size());
      stream_->Send("set#token Token = " + ours_ + " " +
                    TokenProof(token_, "caller", theirs_, ours_));
      return;
    }
    if (message->slot != "Token" ||
        !SameProof(message->value, TokenProof(token_, "listener", theirs_, ours_)))
      return End(Fail(Errc::kAccess, "the token was refused"));
    End({});
  }

  void End(Result<void> result) {
    if (done_ == nullptr) return;
    limit_.cancel();
    // Lines that came along with the last one are kept for whoever gets the stream.
    stream_->PauseReading();
    // From the loop: we are inside one of the stream's callbacks, which the next owner replaces.
    asio::post(io_, [self = shared_from_this(), result = std::move(result),
                     done = std::exchange(done_, nullptr)] {
      if (!result) {
        self->stream_->Flush([stream = self->stream_] { stream->Close(); });
      }
      done(result);
    });
  }

  asio::io_context& io_;
  std::shared_ptr<StreamPeer> stream_;
  std::string token_;
  asio::steady_timer limit_;
  std::string ours_, theirs_;
  std::function<void(const std::string&)> on_line_;
  Done done_;
};

class AcceptorImpl final : public Acceptor {
 public:
  AcceptorImpl(asio::io_context& io, const Endpoint& endpoint, const Credentials& credentials,
               Framing framing, Encoding encoding, OnConnection on_connection, OnRefusal on_refusal)
      : io_(io),
        framing_(framing),
        encoding_(encoding),
        on_connection_(std::move(on_connection)),
        on_refusal_(std::move(on_refusal)) {
    if (const auto checked = CheckListening(endpoint, credentials); !checked)
      throw std::runtime_error(checked.error().text);
    const auto token = ReadToken(credentials);
    if (!token) throw std::runtime_error(token.error().text);
    token_ = *token;
    if (endpoint.kind == Endpoint::Kind::kTls) tls_ = Tls::ForListener(credentials);
    listener_ = Listener::Open(
        io, endpoint, [this](int fd, const std::string&) { OnAccept(fd); }, on_refusal_);
  }
  ~AcceptorImpl() override { *alive_ = false; }
  Endpoint endpoint() const override { return listener_->endpoint(); }

 private:
  void OnAccept(int fd) {
    const std::string from = OtherEnd(fd);
    const unsigned id = ++last_id_;
    // Whoever has been silent for longest makes room, so that strangers cannot lock the others out.
    if (unadmitted_.size() >= kMaxUnadmitted) {
      shutdown(unadmitted_.begin()->second, SHUT_RDWR);
      unadmitted_.erase(unadmitted_.begin());
    }
    unadmitted_[id] = fd;
    if (tls_ == nullptr) return Ask(id, fd, from);
    tls_->Wrap(io_, fd, "", [this, id, alive = alive_, from](Result<Tls::Plain> plain) {
      if (!*alive) {
        if (plain) close(plain->fd);
        return;
      }
      if (plain) return Ask(id, plain->fd, plain->name.empty() ? from : from + " " + plain->name);
      unadmitted_.erase(id);
      Refused(from, plain.error().text);
    });
  }
  void Ask(unsigned id, int fd, const std::string& from) {
    const auto stream = StreamPeer::Make(io_, fd, fd, framing_, encoding_);
    if (const auto found = unadmitted_.find(id); found != unadmitted_.end()) found->second = fd;
    if (token_.empty()) {
      unadmitted_.erase(id);
      return on_connection_({stream, from});
    }
    std::make_shared<Handshake>(io_, stream, token_)
        ->Admit([this, id, alive = alive_, stream, from](Result<void> result) {
          if (!*alive) return stream->Close();
          unadmitted_.erase(id);
          result ? on_connection_({stream, from}) : Refused(from, result.error().text);
        });
  }
  void Refused(const std::string& from, const std::string& why) {
    if (on_refusal_) on_refusal_(FormatEndpoint(endpoint()) + ": refused " + from + ": " + why);
  }

  asio::io_context& io_;
  Framing framing_;
  Encoding encoding_;
  OnConnection on_connection_;
  OnRefusal on_refusal_;
  std::string token_;
  std::shared_ptr<Tls> tls_;
  std::unique_ptr<Listener> listener_;
  std::map<unsigned, int>
      unadmitted_;  // in order of coming: the descriptors that are shut for room
  unsigned last_id_ = 0;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

}  // namespace

std::unique_ptr<Acceptor> Acceptor::Open(asio::io_context& io, const Endpoint& endpoint,
                                         const Credentials& credentials, Framing framing,
                                         Encoding encoding, OnConnection on_connection,
                                         OnRefusal on_refusal) {
  return std::make_unique<AcceptorImpl>(io, endpoint, credentials, framing, encoding,
                                        std::move(on_connection), std::move(on_refusal));
}

void Connect(asio::io_context& io, const Endpoint& endpoint, const Credentials& credentials,
             Framing framing, Encoding encoding,
             std::function<void(Result<std::shared_ptr<StreamPeer>>)> done) {
  const auto token = ReadToken(credentials);
  if (!token) return done(std::unexpected(token.error()));
  std::shared_ptr<Tls> tls;
  try {
    if (endpoint.kind == Endpoint::Kind::kTls) tls = Tls::ForCaller(credentials);
  } catch (const std::runtime_error& error) {
    return done(Fail(Errc::kUnavailable, error.what()));
  }
  const auto show = [&io, token = *token, framing, encoding, endpoint, done](int fd) {
    const auto stream = StreamPeer::Make(io, fd, fd, framing, encoding);
    if (token.empty()) return done(stream);
    std::make_shared<Handshake>(io, stream, token)
        ->Show([stream, endpoint, done](Result<void> result) {
          if (result) return done(stream);
          done(Fail(result.error().code, FormatEndpoint(endpoint) + ": " + result.error().text));
        });
  };
  ConnectTo(io, endpoint, [&io, tls, endpoint, show, done](Result<int> fd) {
    if (!fd) return done(std::unexpected(fd.error()));
    if (tls == nullptr) return show(*fd);
    tls->Wrap(io, *fd, endpoint.host, [show, endpoint, done](Result<Tls::Plain> plain) {
      if (plain) return show(plain->fd);
      done(Fail(plain.error().code, FormatEndpoint(endpoint) + ": " + plain.error().text));
    });
  });
}

}  // namespace vm
