// Sends pictures of the face or the sound of the voice to a browser: a WebSocket, a piece a
// message.

#include <chrono>
#include <deque>
#include <utility>

#include "agent_manager/web/web_impl.h"
#include "vm_protocol/web/web_socket.h"

namespace am::web {
namespace {

constexpr std::size_t kMaxMessageBytes = 128;           // a browser has nothing to say here
constexpr std::size_t kMaxWaitingBytes = 512u * 1024;   // of sound: 16 s
constexpr auto kWriteLimit = std::chrono::seconds(10);  // for a browser to take one piece

/// One browser that watches the face or listens to the voice, until either side ends.
/// Lifetime: kept alive by the stream it follows and its pending operations. Thread: the context's.
/// Limits: a browser that is slow gets fewer pictures, not older ones; one that has not taken
/// kMaxWaitingBytes of sound, or a piece within kWriteLimit, is let go.
class LiveSession : public std::enable_shared_from_this<LiveSession> {
 public:
  LiveSession(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream, Live live)
      : server_(std::move(server)),
        place_(*server_->door),
        socket_(std::move(stream), {.message_bytes = kMaxMessageBytes, .write = kWriteLimit}),
        live_(live) {}

  void Start(const Request& request) {
    socket_.Accept(request, "", [self = shared_from_this()](const Error& error) {
      if (error || self->server_->closed) return;
      self->Read();
      self->Join();
    });
  }

 private:
  using Error = vm::WebSocket::Error;
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
    const std::string_view bytes(reinterpret_cast<const char*>(going_->bytes.data()),
                                 going_->bytes.size());
    socket_.Write(header_, bytes, true, [self = shared_from_this()](const Error& error) {
      self->writing_ = false;
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
    socket_.Close(why_, [self = shared_from_this()](const Error&) { self->Leave(); });
  }

  void Read() {
    socket_.Read([self = shared_from_this()](const Error& error, const std::string&, bool) {
      if (error || self->server_->closed) return self->Leave();
      self->Read();
    });
  }

  void Leave() {
    over_ = true;
    socket_.Cut();
    const unsigned number = std::exchange(number_, 0);
    if (number == 0 || server_->closed) return;
    Source().Leave(number);
  }

  std::shared_ptr<WebServer::Impl> server_;
  const vm::WebDoor::Place place_;
  vm::WebSocket socket_;
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

void ServeLive(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream,
               const Request& request, Live live) {
  std::make_shared<LiveSession>(std::move(server), std::move(stream), live)->Start(request);
}

}  // namespace am::web
