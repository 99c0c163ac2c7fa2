#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "vm_protocol/runtime/credentials.h"
#include "vm_protocol/runtime/endpoint.h"
#include "vm_protocol/runtime/stream_peer.h"
#include "vm_protocol/runtime/tls.h"

namespace vm {

/// A place where others come in, and what is asked of them before anybody hears a line of theirs:
/// TLS where the endpoint says so, the token where there is one.
/// Limits: kMaxUnadmitted at once who have not shown what is asked, kAdmissionLimit for each; one
/// more makes the one go that came first.
class Acceptor {
 public:
  static constexpr std::size_t kMaxUnadmitted = 256;
  struct Connection {
    std::shared_ptr<StreamPeer> stream;  ///< not started again yet: call Start, then ResumeReading
    std::string from;                    ///< where it comes from, and its certificate's name
  };
  using OnConnection = std::function<void(Connection connection)>;
  using OnRefusal = std::function<void(const std::string& text)>;
  /// Throws std::runtime_error with a sentence: the endpoint cannot be had, the files cannot be
  /// used, or it would be open to everybody.
  static std::unique_ptr<Acceptor> Open(boost::asio::io_context& io, const Endpoint& endpoint,
                                        const Credentials& credentials, Framing framing,
                                        Encoding encoding, OnConnection on_connection,
                                        OnRefusal on_refusal);
  virtual ~Acceptor() = default;
  virtual Endpoint endpoint() const = 0;
};

/// Goes to a listener and shows what it asks for. `done` gets a stream to be started by Start and
/// ResumeReading, or a sentence. Files are read anew each time.
void Connect(boost::asio::io_context& io, const Endpoint& endpoint, const Credentials& credentials,
             Framing framing, Encoding encoding,
             std::function<void(Result<std::shared_ptr<StreamPeer>>)> done);

}  // namespace vm
