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
  /// `ca_file` (PEM): whose signatures count; empty: those the system trusts.
  explicit HttpCaller(std::string ca_file);
  ~HttpCaller();
  HttpCaller(const HttpCaller&) = delete;

  /// Any status is an answer.
  Result<HttpAnswer> Post(const HttpRequest& request, std::chrono::milliseconds stall,
                          const std::atomic<bool>& cancelled);

 private:
  struct Impl;
  const std::unique_ptr<Impl> impl_;
};

}  // namespace vm
