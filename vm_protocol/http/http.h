#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vm {

struct HttpRequest {
  std::string url{};
  std::vector<std::string> headers{};  ///< "Name: value"
  std::string body{};
  std::chrono::milliseconds limit{60'000};  ///< for the whole exchange
  std::size_t max_bytes = std::size_t{16} << 20;
  /// Compressed answers are taken, too; max_bytes counts what they unpack to.
  bool unpacked = false;
};

struct HttpHead {
  int status = 0;
  std::map<std::string, std::string> headers;  ///< names in lower case
};

/// Called on the scheduler's thread, never from within Post: the head, data as it comes, and once
/// the end; none after the exchange is destroyed.
struct HttpEvents {
  std::function<void(const HttpHead& head)> on_head;
  std::function<void(std::string_view bytes)> on_data;
  /// kUnavailable, kTimeout, kTooLong; a status is no error.
  std::function<void(const vm::Result<void>& end)> on_end;
};

/// A request under way. Destroying it ends the connection.
class HttpExchange {
 public:
  virtual ~HttpExchange() = default;
};

/// What carries requests: the network, or a test.
class HttpTransport {
 public:
  virtual ~HttpTransport() = default;
  virtual std::unique_ptr<HttpExchange> Post(HttpRequest request, HttpEvents events) = 0;
};

}  // namespace vm
