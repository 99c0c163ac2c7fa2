// Makes a WebSocket a peer of the hub.

#include <algorithm>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <utility>

#include "agent_manager/web/web_impl.h"
#include "vm_protocol/core/limits.h"

namespace am::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

/// One WebSocket. The hub owns its link, which shares the session: the link's end closes the
/// socket, and the socket's end makes the peer leave the hub. Lifetime: kept alive by the link and
/// its pending operations. Thread: the context's. Limits: vm::kMaxLineBytes a message; a longer one
/// ends the connection.
class SocketSession : public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(std::shared_ptr<WebServer::Impl> server, beast::tcp_stream stream)
      : server_(std::move(server)), place_(*server_->door), socket_(std::move(stream)) {}

  void Start(const Request& request) {
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.read_message_max(vm::kMaxLineBytes);
    const bool names_protocol = request[beast::http::field::sec_websocket_protocol] == "galatea";
    socket_.set_option(
        websocket::stream_base::decorator([names_protocol](websocket::response_type& response) {
          if (names_protocol) response.set(beast::http::field::sec_websocket_protocol, "galatea");
        }));
    socket_.text(true);
    socket_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (!error) self->Join();
    });
  }

  void Send(std::string_view line) {
    if (ended_) return;
    backlog_ += line.size();
    outgoing_.emplace_back(line);
    if (!writing_) Write();
  }
  void End() {
    if (std::exchange(ended_, true)) return;
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
  }
  void Pause(bool paused) {
    paused_ = paused;
    if (!paused && !reading_ && !ended_ && peer_ != 0) Read();
  }
  std::size_t backlog() const { return backlog_; }

 private:
  class SocketLink final : public Link {
   public:
    explicit SocketLink(std::shared_ptr<SocketSession> session) : session_(std::move(session)) {}
    ~SocketLink() override { session_->End(); }
    void Send(const Outgoing& outgoing) override { session_->Send(outgoing.line()); }
    void SendComment(std::string_view text) override { session_->Send(text); }
    void Close() override { session_->End(); }
    void PauseReading() override { session_->Pause(true); }
    void ResumeReading() override { session_->Pause(false); }
    std::size_t backlog_bytes() const override { return session_->backlog(); }

   private:
    std::shared_ptr<SocketSession> session_;
  };

  void Join() {
    if (server_->closed) return;
    const auto key = server_->hub.Attach(std::make_unique<SocketLink>(shared_from_this()),
                                         PeerKind::kClient, server_->role, "", Dialect::kAuto);
    if (!key) return server_->on_refusal("" + key.error().text);
    peer_ = *key;
    Read();
  }

  void Read() {
    if (reading_ || paused_ || ended_) return;
    reading_ = true;
    socket_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      self->reading_ = false;
      self->OnRead(error);
    });
  }

  void OnRead(const error_code& error) {
    if (server_->closed) return;
    if (error) {
      const PeerKey peer = std::exchange(peer_, 0);
      if (error == websocket::error::message_too_big) {
        const std::string why = "a message over " + std::to_string(vm::kMaxLineBytes) + " bytes";
        server_->on_refusal("refused " + why);
        return server_->hub.Leave(peer, why);
      }
      return server_->hub.Leave(
          peer, error == websocket::error::closed ? "end of input" : error.message());
    }
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    // Usually one line; several are received in their order.
    std::string_view rest = text;
    while (!rest.empty() && peer_ != 0 && !ended_) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      server_->hub.Receive(peer_, rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    Read();
  }

  void Write() {
    writing_ = true;
    socket_.async_write(asio::buffer(outgoing_.front()),
                        [self = shared_from_this()](const error_code& error, std::size_t) {
                          self->backlog_ -= self->outgoing_.front().size();
                          self->outgoing_.pop_front();
                          self->writing_ = false;
                          if (!error && !self->outgoing_.empty()) self->Write();
                        });
  }

  std::shared_ptr<WebServer::Impl> server_;
  const vm::WebDoor::Place place_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  std::deque<std::string> outgoing_;
  std::size_t backlog_ = 0;
  PeerKey peer_ = 0;
  bool reading_ = false, writing_ = false, paused_ = false, ended_ = false;
};

}  // namespace

void ServeSocket(std::shared_ptr<WebServer::Impl> server, beast::tcp_stream stream,
                 const Request& request) {
  std::make_shared<SocketSession>(std::move(server), std::move(stream))->Start(request);
}

}  // namespace am::web
