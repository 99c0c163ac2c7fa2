// One client's WebSocket: sound in, weights out.

#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <utility>

#include "gateway/face/face_messages.h"
#include "gateway/web/gateway_impl.h"

namespace gateway {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

constexpr std::size_t kMaxMessageBytes = 1u << 20;
constexpr std::size_t kPieceBytes = 32u << 10;  // worked on in one turn of the loop
constexpr std::size_t kMaxBacklog = 4u << 20;   // of one client; beyond, its sound is not read
constexpr auto kWriteLimit = std::chrono::seconds(10);

/// Lifetime: kept alive by its pending operations. Thread: the context's. Limits: kMaxMessageBytes
/// a message; while more than kMaxBacklog is not taken, nothing is read; a message that is not
/// taken for kWriteLimit ends the connection. Errors: a message that is none is answered.
class MouthSession : public std::enable_shared_from_this<MouthSession> {
 public:
  MouthSession(std::shared_ptr<GatewayServer::Impl> server, beast::tcp_stream stream,
               const LiveFace::Settings& settings)
      : server_(std::move(server)),
        socket_(std::move(stream)),
        write_timer_(server_->io),
        face_(server_->net, settings) {
    ++server_->clients;
  }
  ~MouthSession() { --server_->clients; }
  MouthSession(const MouthSession&) = delete;

  void Start(const HttpRequest& request) {
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.read_message_max(kMaxMessageBytes);
    socket_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error) return;
      self->Send(ReadyText(self->face_));
      self->Read();
    });
  }

 private:
  void Read() {
    if (reading_ || ended_ || backlog_ > kMaxBacklog) return;
    reading_ = true;
    socket_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error || self->server_->closed) return self->End();
      self->message_ = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      self->taken_ = 0;
      self->Take();
    });
  }

  /// A piece of the message in each turn of the loop, so that other clients do not wait.
  void Take() {
    if (ended_ || server_->closed) return End();
    if (!socket_.got_binary()) {
      TakeControl();
      taken_ = message_.size();
    } else {
      Tell(face_.Add(std::string_view(message_).substr(taken_, kPieceBytes)));
      taken_ += kPieceBytes;
    }
    if (taken_ < message_.size()) {
      return asio::post(server_->io, [self = shared_from_this()] { self->Take(); });
    }
    reading_ = false;
    Read();
  }

  void TakeControl() {
    const auto control = ReadControl(message_);
    if (!control) return Send(ErrorText(control.error().text));
    if (*control == Control::kClear) {
      face_.Clear();
      // What was said of the sound and has not gone yet is void, but for the message on its way.
      while (outgoing_.size() > (writing_ ? 1u : 0u)) {
        backlog_ -= outgoing_.back().size();
        outgoing_.pop_back();
      }
      return Send(ClearedText());
    }
    const double heard_s = face_.heard_s();
    Tell(face_.End());
    Send(EndText(heard_s));
  }

  void Tell(const std::vector<LiveFace::Moment>& moments) {
    for (const auto& moment : moments) Send(FrameText(*face_.settings().set, moment));
  }

  void Send(std::string text) {
    if (ended_) return;
    backlog_ += text.size();
    outgoing_.push_back(std::move(text));
    if (!writing_) Write();
  }

  void Write() {
    writing_ = true;
    write_timer_.expires_after(kWriteLimit);
    write_timer_.async_wait([weak = weak_from_this()](const error_code& error) {
      const auto self = weak.lock();
      if (!error && self) self->End();
    });
    socket_.text(true);
    socket_.async_write(asio::buffer(outgoing_.front()),
                        [self = shared_from_this()](const error_code& error, std::size_t) {
                          self->write_timer_.cancel();
                          self->backlog_ -= self->outgoing_.front().size();
                          self->outgoing_.pop_front();
                          self->writing_ = false;
                          if (error) return self->End();
                          if (!self->outgoing_.empty()) self->Write();
                          self->Read();
                        });
  }

  void End() {
    if (std::exchange(ended_, true)) return;
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
  }

  const std::shared_ptr<GatewayServer::Impl> server_;
  websocket::stream<beast::tcp_stream> socket_;
  asio::steady_timer write_timer_;
  LiveFace face_;
  beast::flat_buffer buffer_;
  std::string message_;    // being worked on
  std::size_t taken_ = 0;  // bytes of it
  std::deque<std::string> outgoing_;
  std::size_t backlog_ = 0;  // bytes of it
  bool reading_ = false, writing_ = false, ended_ = false;
};

}  // namespace

void ServeMouth(std::shared_ptr<GatewayServer::Impl> server, beast::tcp_stream stream,
                const HttpRequest& request, const LiveFace::Settings& settings) {
  std::make_shared<MouthSession>(std::move(server), std::move(stream), settings)->Start(request);
}

}  // namespace gateway
