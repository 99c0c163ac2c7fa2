#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>

#include "vm_protocol/http/http.h"

namespace vm {

struct HttpAnswer {
  HttpHead head;
  std::string body;
};

/// HTTP by libcurl for a thread that waits: over http and https, with certificates checked;
/// redirections are not followed. The connection is kept from one call to the next.
/// Thread: one at a time. Errors: kUnavailable, kTimeout (the request's limit; or nothing has come
/// for `stall`), kTooLong, kStopped (within 50 ms after `cancelled` became true).
class HttpCaller {
 public:
  static constexpr std::size_t kMaxCookies = 300;
  /// `ca_file` (PEM): whose signatures count; empty: those the system trusts. `cookies`: they are
  /// kept as long as this object (RFC 6265, libcurl's engine), in memory only; over kMaxCookies all
  /// are forgotten.
  explicit HttpCaller(std::string ca_file, bool cookies = false);
  ~HttpCaller();
  HttpCaller(const HttpCaller&) = delete;

  /// Any status is an answer.
  Result<HttpAnswer> Post(const HttpRequest& request, std::chrono::milliseconds stall,
                          const std::atomic<bool>& cancelled);
  /// The request's body does not count.
  Result<HttpAnswer> Get(const HttpRequest& request, std::chrono::milliseconds stall,
                         const std::atomic<bool>& cancelled);

 private:
  struct Impl;
  const std::unique_ptr<Impl> impl_;
};

}  // namespace vm
