#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>

#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/http/http.h"

namespace vm {

/// HTTP by libcurl, over http and https, with certificates checked; redirections are not followed.
/// On the real clock one thread of its own carries all exchanges, and what comes is handed to the
/// io_context. On a virtual clock time stands while the network answers: Post waits for the end of
/// the exchange, whose events then all happen at that instant.
/// Lifetime: clock and context outlive it; it outlives its exchanges. Thread: the context's.
class CurlTransport final : public HttpTransport {
 public:
  /// `real` says whether time passes by itself just now. `ca_file` (PEM): whose signatures count;
  /// empty: those the system trusts.
  CurlTransport(boost::asio::io_context& io, vm::Scheduler& clock, std::function<bool()> real,
                std::string ca_file);
  ~CurlTransport() override;
  std::unique_ptr<HttpExchange> Post(HttpRequest request, HttpEvents events) override;

  struct Transfer;
  class Loop;

 private:
  boost::asio::io_context& io_;
  vm::Scheduler& clock_;
  const std::function<bool()> real_;
  const std::string ca_file_;
  std::unique_ptr<Loop> loop_;  // begun with the first exchange
};

}  // namespace vm
