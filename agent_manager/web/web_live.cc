// Sends pictures of the face or the sound of the voice to a browser: a WebSocket, a piece a
// message.

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <utility>

#include "agent_manager/web/web_impl.h"
#include "vm_protocol/core/utf8.h"

namespace am::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;
using boost::system::error_code;

constexpr std::size_t kMaxMessageBytes = 128;           // a browser has nothing to say here
constexpr std::size_t kMaxWaitingBytes = 512u * 1024;   // of sound: 16 s
constexpr auto kWriteLimit = std::chrono::seconds(10);  // for a browser to take one piece

/// One browser that watches the face or listens to the voice, until either side ends.
/// Lifetime: kept alive by the stream it follows and its pending operations. Thread: the context's.
/// Limits: a browser that is slow gets fewer pictures, not older ones; one that has not taken
/// kMaxWaitingBytes of sound, or a piece within kWriteLimit, is let go.
class LiveSession : public std::enable_shared_from_this<LiveSession> {
 public:
  LiveSession(std::shared_ptr<WebServer::Impl> server, beast::tcp_stream stream, Live live)
      : server_(std::move(server)),
        place_(*server_->door),
        socket_(std::move(stream)),
        write_limit_(server_->io),
        live_(live) {}

  void Start(const Request& request) {
    socket_.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    socket_.read_message_max(kMaxMessageBytes);
    socket_.binary(true);
    socket_.async_accept(request, [self = shared_from_this()](const error_code& error) {
      if (error || self->server_->closed) return;
      self->Read();
      self->Join();
    });
  }

 private:
  LiveSource& Source() { return *(live_ == Live::kFace ? server_->face : server_->voice); }

  void Join() {
    Audience::Member member{
        [self = shared_from_this()](const Audience::Piece& piece) { self->OnPiece(piece); },
        [self = shared_from_this()](const std::string& why) { self->OnEnd(why); }};
    const unsigned number = Source().Join(std::move(member));
    if (!over_) number_ = number;  // else it has ended already
  }

  void OnPiece(const Audience::Piece& piece) {
    if (live_ == Live::kFace) {
      waiting_.clear();
    } else {
      waiting_bytes_ += piece->bytes.size();
      if (waiting_bytes_ > kMaxWaitingBytes) return Leave();
    }
    waiting_.push_back(piece);
    if (!writing_) Write();
  }

  void Write() {
    writing_ = true;
    going_ = waiting_.front();
    waiting_.pop_front();
    header_ = vm::LiveHeader(going_->kind, going_->rate_hz,
                             static_cast<double>(going_->at.count()) / 1000);
    write_limit_.expires_after(kWriteLimit);
    write_limit_.async_wait([weak = weak_from_this()](const error_code& stopped) {
      const auto self = weak.lock();
      if (!stopped && self) self->Leave();
    });
    const std::array<asio::const_buffer, 2> buffers{asio::buffer(header_),
                                                    asio::buffer(going_->bytes)};
    socket_.async_write(buffers, [self = shared_from_this()](const error_code& error, std::size_t) {
      self->writing_ = false;
      self->write_limit_.cancel();
      if (self->live_ == Live::kVoice) self->waiting_bytes_ -= self->going_->bytes.size();
      if (error) return self->Leave();
      if (!self->waiting_.empty()) return self->Write();
      if (self->over_) self->Close();
    });
  }

  void OnEnd(const std::string& why) {
    number_ = 0;
    over_ = true;
    why_ = why;
    if (!writing_) Close();
  }

  /// Says why nothing follows.
  void Close() {
    // Beast takes at most 123 bytes of reason.
    socket_.async_close({websocket::close_code::try_again_later, vm::CutUtf8(why_, 120)},
                        [self = shared_from_this()](const error_code&) { self->Leave(); });
  }

  void Read() {
    socket_.async_read(buffer_, [self = shared_from_this()](const error_code& error, std::size_t) {
      if (error || self->server_->closed) return self->Leave();
      self->buffer_.consume(self->buffer_.size());
      self->Read();
    });
  }

  void Leave() {
    over_ = true;
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
    const unsigned number = std::exchange(number_, 0);
    if (number == 0 || server_->closed) return;
    Source().Leave(number);
  }

  std::shared_ptr<WebServer::Impl> server_;
  const vm::WebDoor::Place place_;
  websocket::stream<beast::tcp_stream> socket_;
  asio::steady_timer write_limit_;
  beast::flat_buffer buffer_;
  const Live live_;
  std::deque<Audience::Piece> waiting_;
  std::size_t waiting_bytes_ = 0;  // of sound, with what is being written
  Audience::Piece going_;
  std::string header_;
  std::string why_;
  unsigned number_ = 0;  // in the audience
  bool writing_ = false, over_ = false;
};

}  // namespace

void ServeLive(std::shared_ptr<WebServer::Impl> server, beast::tcp_stream stream,
               const Request& request, Live live) {
  std::make_shared<LiveSession>(std::move(server), std::move(stream), live)->Start(request);
}

}  // namespace am::web
