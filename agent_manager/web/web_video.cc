// Streams pictures of the face to a browser: a multipart response with one JPEG after another.

#include <boost/asio/write.hpp>
#include <chrono>
#include <utility>

#include "agent_manager/web/web_impl.h"

namespace am::web {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;

constexpr auto kPictureLimit = std::chrono::seconds(10);  // for a browser to receive one picture

/// One browser that watches the face; who follows LiveSource until either side ends.
/// Lifetime: kept alive by LiveSource and its pending operations. Thread: the context's.
class VideoSession : public std::enable_shared_from_this<VideoSession> {
 public:
  VideoSession(std::shared_ptr<WebServer::Impl> server, beast::tcp_stream stream)
      : server_(std::move(server)), place_(*server_->door), stream_(std::move(stream)) {}

  void Start() {
    const unsigned viewer = server_->face->Join(
        {[self = shared_from_this()](const Audience::Piece& piece) { self->OnPicture(*piece); },
         [self = shared_from_this()](const std::string&) { self->OnEnd(); }});
    if (!ended_) viewer_ = viewer;
    WaitForClose();
  }

 private:
  void OnEnd() {
    viewer_ = 0;
    // Before the first picture, the request has not been answered.
    if (std::exchange(ended_, true) || began_) return Leave();
    text_ = "HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
    Write();
  }

  void OnPicture(const LivePiece& picture) {
    if (writing_) return;  // a slow browser gets fewer pictures, not older ones
    text_.clear();
    if (!std::exchange(began_, true))
      text_ =
          "HTTP/1.1 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=picture\r\n"
          "Cache-Control: no-store\r\nConnection: close\r\n\r\n";
    text_ += "--picture\r\nContent-Type: image/jpeg\r\nContent-Length: " +
             std::to_string(picture.bytes.size()) + "\r\n\r\n" + picture.bytes + "\r\n";
    Write();
  }

  /// A browser that watches says nothing more: whatever comes is its end, even if no picture does.
  void WaitForClose() {
    stream_.socket().async_wait(asio::socket_base::wait_read,
                                [self = shared_from_this()](const error_code& error) {
                                  if (!error) self->Leave();
                                });
  }

  void Write() {
    writing_ = true;
    stream_.expires_after(kPictureLimit);
    asio::async_write(stream_, asio::buffer(text_),
                      [self = shared_from_this()](const error_code& error, std::size_t) {
                        self->writing_ = false;
                        if (error || self->ended_) self->Leave();
                      });
  }

  void Leave() {
    ended_ = true;
    error_code ignored;
    stream_.socket().close(ignored);
    if (const unsigned viewer = std::exchange(viewer_, 0);
        viewer != 0 && !server_->closed && server_->face)
      server_->face->Leave(viewer);
  }

  std::shared_ptr<WebServer::Impl> server_;
  const vm::WebDoor::Place place_;
  beast::tcp_stream stream_;
  std::string text_;
  unsigned viewer_ = 0;
  bool began_ = false, writing_ = false, ended_ = false;
};

}  // namespace

void ServeVideo(std::shared_ptr<WebServer::Impl> server, beast::tcp_stream stream) {
  std::make_shared<VideoSession>(std::move(server), std::move(stream))->Start();
}

}  // namespace am::web
