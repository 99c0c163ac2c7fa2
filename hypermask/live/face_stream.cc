#include "hypermask/live/face_stream.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <charconv>
#include <span>
#include <string_view>

#include "fsm/image/image_codec.h"

namespace hypermask {

namespace asio = boost::asio;
using boost::system::error_code;

bool PictureRecords::Add(std::string_view piece, std::string& why) {
  constexpr std::size_t kMaxHead = 100;
  constexpr std::string_view kPicture = "picture ";
  come_ += piece;
  std::string_view rest = come_;
  while (true) {
    const std::size_t line = rest.substr(0, kMaxHead).find('\n');
    if (line == std::string_view::npos) {
      if (rest.size() < kMaxHead) break;
      why = "sent a record whose first line has no end";
      return false;
    }
    const std::string_view head = rest.substr(0, line);
    const std::size_t blank = head.rfind(' ');
    std::size_t bytes = 0;
    const char* const end = head.data() + head.size();
    const bool fits = head.starts_with(kPicture) && blank > kPicture.size() &&
                      std::from_chars(head.data() + blank + 1, end, bytes).ptr == end &&
                      bytes > 0 && bytes <= FaceStream::kMaxBytes;
    if (!fits) {
      why = fmt::format("sent '{}', expected picture MS BYTES of at most {} bytes", head,
                        FaceStream::kMaxBytes);
      return false;
    }
    if (rest.size() - line - 1 < bytes) break;
    newest_ = rest.substr(line + 1, bytes);
    rest.remove_prefix(line + 1 + bytes);
  }
  come_.erase(0, come_.size() - rest.size());
  return true;
}

struct FaceStream::Listener : std::enable_shared_from_this<Listener> {
  Listener(asio::io_context& io, Events e) : events(std::move(e)), acceptor(io), socket(io) {}
  ~Listener() {
    if (folder.empty()) return;
    unlink(file.c_str());
    rmdir(folder.c_str());
  }
  void Accept() {
    acceptor.async_accept(socket, [weak = weak_from_this()](const error_code& error) {
      const auto here = weak.lock();
      if (!here || error) return;
      here->records = {};
      here->Read();
    });
  }
  void Read() {
    socket.async_read_some(asio::buffer(piece),
                           [weak = weak_from_this()](const error_code& error, std::size_t size) {
                             if (const auto here = weak.lock()) here->Take(error, size);
                           });
  }
  void Take(const error_code& error, std::size_t size) {
    if (over) return;
    std::string why = "sends no more";
    bool go_on = !error && records.Add({piece.data(), size}, why);
    if (const std::string jpeg = records.TakeNewest(); go_on && !jpeg.empty()) {
      const auto picture = fsm::DecodeJpeg(
          std::span(reinterpret_cast<const std::uint8_t*>(jpeg.data()), jpeg.size()));
      if (picture) {
        events.picture(*picture);
        if (over) return;
      } else {
        why = "sent a picture that cannot be read: " + picture.error().text;
        go_on = false;
      }
    }
    if (go_on) return Read();
    error_code ignored;
    socket.close(ignored);
    events.gone({vm::Errc::kUnavailable, "the face " + why});
    if (!over) Accept();
  }

  const Events events;
  std::string folder, file;
  bool over = false;  // nobody wants events any more
  asio::local::stream_protocol::acceptor acceptor;
  asio::local::stream_protocol::socket socket;
  std::array<char, 64u * 1024> piece{};
  PictureRecords records;
};

vm::Result<std::unique_ptr<FaceStream>> FaceStream::Listen(asio::io_context& io, Events events) {
  const auto listener = std::make_shared<Listener>(io, std::move(events));
  std::string folder = "/tmp/galatea-mask-XXXXXX";
  if (mkdtemp(folder.data()) == nullptr) {
    return vm::Fail(vm::Errc::kUnavailable, "no folder can be made under /tmp for a socket");
  }
  listener->folder = folder;
  listener->file = folder + "/face";
  error_code error;
  listener->acceptor.open(asio::local::stream_protocol(), error);
  if (!error) listener->acceptor.bind(listener->file, error);
  if (!error) listener->acceptor.listen(1, error);
  if (error) {
    return vm::Fail(vm::Errc::kUnavailable, "no socket for the face: " + error.message());
  }
  listener->Accept();
  return std::unique_ptr<FaceStream>(new FaceStream(listener));
}

FaceStream::~FaceStream() {
  listener_->over = true;
  error_code ignored;
  listener_->acceptor.close(ignored);
  listener_->socket.close(ignored);
}

std::string FaceStream::place() const { return "unix:" + listener_->file; }

}  // namespace hypermask
