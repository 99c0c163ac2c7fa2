#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <string_view>

#include "vm_protocol/runtime/endpoint.h"

namespace vm {

/// Where a web server takes connections, so many at a time. One that has not shown the token yet
/// gives way to a new one, the oldest first, so that silence takes nobody's place; where all have
/// shown it, who comes is answered 503. Thread: the context's. Errors: told, each kind once until
/// it is over.
class WebDoor {
 public:
  using OnSocket = std::function<void(boost::asio::ip::tcp::socket socket)>;
  using OnTrouble = std::function<void(const std::string& text)>;
  static constexpr std::size_t kMaxConnections = 64;

  /// `at`: tcp:HOST:PORT, port 0 any free one. Throws std::runtime_error with a sentence.
  WebDoor(boost::asio::io_context& io, std::string_view at, OnSocket on_socket,
          OnTrouble on_trouble);
  WebDoor(const WebDoor&) = delete;
  /// Nobody is let in any more; who is inside stays.
  void Close() { listener_.reset(); }
  /// "127.0.0.1:8080", "[::1]:8080"
  const std::string& host() const { return host_; }

  /// Counts one connection while it lives.
  class Place {
   public:
    explicit Place(WebDoor& door) : door_(door) { ++door_.taken_; }
    ~Place() { --door_.taken_; }
    Place(const Place&) = delete;

   private:
    WebDoor& door_;
  };
  /// A connection that has not shown the token, while it lives. `drop` ends it, and this with it.
  class Stranger {
   public:
    Stranger(WebDoor& door, std::function<void()> drop)
        : door_(door), at_(door.strangers_.insert(door.strangers_.end(), std::move(drop))) {}
    ~Stranger() { door_.strangers_.erase(at_); }
    Stranger(const Stranger&) = delete;

   private:
    WebDoor& door_;
    std::list<std::function<void()>>::iterator at_;
  };

 private:
  void Enter(boost::asio::ip::tcp::socket socket);

  const OnSocket on_socket_;
  const OnTrouble on_trouble_;
  std::size_t taken_ = 0;
  bool full_ = false;                           // the last connection was turned away
  std::list<std::function<void()>> strangers_;  // the oldest first
  std::string host_;
  std::unique_ptr<Listener> listener_;
};

}  // namespace vm
