// Makes a WebSocket a peer of the hub.

#include "vm_protocol/web/web_socket.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "agent_manager/web/web_impl.h"
#include "vm_protocol/core/limits.h"

namespace am::web {
namespace {

/// One WebSocket. The hub owns its link, which shares the session: the link's end closes the
/// socket, and the socket's end makes the peer leave the hub. Lifetime: kept alive by the link and
/// its pending operations. Thread: the context's. Limits: vm::kMaxLineBytes a message; a longer one
/// ends the connection.
class SocketSession : public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream)
      : server_(std::move(server)),
        place_(*server_->door),
        socket_(std::move(stream), {.message_bytes = vm::kMaxLineBytes}) {}

  void Start(const Request& request) {
    socket_.Accept(request, "galatea", [self = shared_from_this()](const Error& error) {
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
    socket_.Cut();
  }
  void Pause(bool paused) {
    paused_ = paused;
    if (!paused && !reading_ && !ended_ && peer_ != 0) Read();
  }
  std::size_t backlog() const { return backlog_; }

 private:
  using Error = vm::WebSocket::Error;
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
    socket_.Read([self = shared_from_this()](const Error& error, const std::string& text, bool) {
      self->reading_ = false;
      self->OnRead(error, text);
    });
  }

  void OnRead(const Error& error, const std::string& text) {
    if (server_->closed) return;
    if (error) {
      const PeerKey peer = std::exchange(peer_, 0);
      if (vm::WebSocket::IsTooLong(error)) {
        const std::string why = "a message over " + std::to_string(vm::kMaxLineBytes) + " bytes";
        server_->on_refusal("refused " + why);
        return server_->hub.Leave(peer, why);
      }
      return server_->hub.Leave(peer,
                                vm::WebSocket::IsGoodbye(error) ? "end of input" : error.message());
    }
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
    socket_.Write(outgoing_.front(), "", false, [self = shared_from_this()](const Error& error) {
      self->backlog_ -= self->outgoing_.front().size();
      self->outgoing_.pop_front();
      self->writing_ = false;
      if (!error && !self->outgoing_.empty()) self->Write();
    });
  }

  std::shared_ptr<WebServer::Impl> server_;
  const vm::WebDoor::Place place_;
  vm::WebSocket socket_;
  std::deque<std::string> outgoing_;
  std::size_t backlog_ = 0;
  PeerKey peer_ = 0;
  bool reading_ = false, writing_ = false, paused_ = false, ended_ = false;
};

}  // namespace

void ServeSocket(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream,
                 const Request& request) {
  std::make_shared<SocketSession>(std::move(server), std::move(stream))->Start(request);
}

}  // namespace am::web
