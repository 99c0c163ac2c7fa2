#pragma once

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "vm_protocol/core/result.h"
#include "vm_protocol/runtime/credentials.h"

namespace vm {

/// TLS 1.2 or newer over a connected socket. What comes out is an ordinary descriptor that carries
/// the plain bytes, so everything else works on it as on any other.
/// Thread: the io_context's. Limits: kTlsHandshakeLimit for the other side to agree; of those that
/// have not agreed yet one is read in each round of the loop, since what it says may cost
/// milliseconds; once our end is closed, the other side has `close_limit` to take what is left.
class Tls {
 public:
  static constexpr std::chrono::milliseconds kCloseLimit{10'000};
  /// Throws std::runtime_error with a sentence if a file cannot be used.
  static std::shared_ptr<Tls> ForListener(const Credentials& credentials,
                                          std::chrono::milliseconds close_limit = kCloseLimit);
  static std::shared_ptr<Tls> ForCaller(const Credentials& credentials,
                                        std::chrono::milliseconds close_limit = kCloseLimit);
  virtual ~Tls() = default;

  struct Plain {
    int fd = -1;       ///< the caller's to close
    std::string name;  ///< the common name in the other side's certificate; empty = it showed none
  };
  using Done = std::function<void(Result<Plain>)>;
  /// Takes the socket over, which stays open until `done` is called. A caller checks that the
  /// certificate is for `host`.
  virtual void Wrap(boost::asio::io_context& io, int fd, const std::string& host, Done done) = 0;
};

}  // namespace vm
