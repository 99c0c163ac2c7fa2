#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "fsm/image/image.h"
#include "vm_protocol/core/result.h"

namespace hypermask {

/// A Unix socket at which the face leaves its pictures (docs/face.md, Pictures for other programs).
/// Thread: the io_context's; no event comes after the destructor, which removes the socket.
/// Limits: one sender at a time, pictures of kMaxBytes; who sends anything else is cut off and the
/// next one waited for.
class FaceStream {
 public:
  static constexpr std::size_t kMaxBytes = 8u * 1024 * 1024;
  struct Events {
    std::function<void(const fsm::Image& picture)> picture{};
    /// The sender has gone, or was cut off; why.
    std::function<void(const vm::Error& error)> gone{};
  };
  /// Error: kUnavailable, no socket can be made.
  static vm::Result<std::unique_ptr<FaceStream>> Listen(boost::asio::io_context& io, Events events);
  ~FaceStream();
  FaceStream(const FaceStream&) = delete;

  /// For the face's slot Picture.to: "unix:PATH".
  std::string place() const;

 private:
  struct Listener;
  explicit FaceStream(std::shared_ptr<Listener> listener) : listener_(std::move(listener)) {}
  const std::shared_ptr<Listener> listener_;
};

/// Takes the records "picture MS BYTES" and their JPEG files out of what comes in pieces. Pure.
class PictureRecords {
 public:
  /// Adds a piece. False if what came is no such record; `why` says so.
  bool Add(std::string_view piece, std::string& why);
  /// The newest whole picture since the last call, JPEG; empty: none.
  std::string TakeNewest() { return std::exchange(newest_, {}); }

 private:
  std::string come_, newest_;
};

}  // namespace hypermask
