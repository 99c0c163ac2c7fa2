#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"
#include "vm_protocol/runtime/stream_peer.h"

namespace vm {

/// unix:PATH | tcp:HOST:PORT | tls:HOST:PORT (HOST a name, an IPv4 address, or [IPv6]). What tls:
/// means beyond TCP is the business of Acceptor and Connect.
struct Endpoint {
  enum class Kind { kUnix, kTcp, kTls };
  Kind kind = Kind::kUnix;
  std::string host;  ///< or the path
  unsigned short port = 0;
};
Result<Endpoint> ParseEndpoint(std::string_view text);
std::string FormatEndpoint(const Endpoint& endpoint);

/// Accepts connections while it lives. A Unix socket's file is made with mode 0600, a stale one
/// (nobody listening) is replaced, and it is removed at the end.
class Listener {
 public:
  using OnAccept = std::function<void(int fd, std::string peer_name)>;
  using OnTrouble = std::function<void(const std::string& text)>;
  /// Throws std::runtime_error with a sentence if the endpoint cannot be had. Port 0: any free one.
  /// Where the system cannot give it a connection, `on_trouble` hears it once; for lack of
  /// descriptors whoever comes is turned away, else it tries again every kAcceptPause.
  static std::unique_ptr<Listener> Open(boost::asio::io_context& io, const Endpoint& endpoint,
                                        OnAccept on_accept, OnTrouble on_trouble = {});
  virtual ~Listener() = default;
  /// Where it really listens (the port chosen for 0).
  virtual Endpoint endpoint() const = 0;
};

/// Connects without blocking the context; names are resolved on a thread of Asio's. All addresses
/// of a name are tried in order. `done` gets a connected descriptor, or kUnavailable with a
/// sentence.
void ConnectTo(boost::asio::io_context& io, const Endpoint& endpoint,
               std::function<void(Result<int> fd)> done);

}  // namespace vm
