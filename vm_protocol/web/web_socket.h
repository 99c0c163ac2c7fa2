#pragma once

#include <boost/asio/buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "vm_protocol/web/visitors.h"

namespace vm {

/// The server's end of a WebSocket. Beast's templates are compiled here once for all servers.
/// Thread: the context's. Lifetime: no operation needs it, but each keeps its handler, and what
/// that holds, until it is called.
/// Limits: of a message, and of the time to write one; a client beyond either fails the operation.
class WebSocket {
 public:
  using Error = boost::system::error_code;
  using Done = std::function<void(const Error& error)>;
  using Received = std::function<void(const Error& error, std::string message, bool binary)>;
  struct Limits {
    std::size_t message_bytes;
    std::chrono::seconds write{0};  ///< for a client to take one message; 0: none
  };

  WebSocket(boost::beast::tcp_stream stream, Limits limits);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;

  /// Answers the request that asked for a WebSocket; `protocol` is told to a client that named it.
  void Accept(const WebRequest& request, std::string_view protocol, Done done);
  /// Reads one message. REQUIRES: no other Read is pending.
  void Read(Received received);
  /// Writes one message of both pieces, whose bytes stay valid until `done`.
  /// REQUIRES: no other Write or Close is pending.
  void Write(std::string_view head, std::string_view body, bool binary, Done done);
  /// Says goodbye with a reason, of which the client gets the first 120 bytes.
  void Close(std::string_view reason, Done done);
  /// Closes the connection at once; what is pending fails.
  void Cut();

  /// What a failed Read met: the client's goodbye, or a message beyond the limit.
  static bool IsGoodbye(const Error& error);
  static bool IsTooLong(const Error& error);

 private:
  struct Stream;
  const std::shared_ptr<Stream> stream_;
};

}  // namespace vm
