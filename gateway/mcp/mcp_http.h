#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/mcp/mcp_server.h"

namespace vm {
struct WebSite;
}

namespace gateway {

/// The Model Context Protocol over HTTP: the streamable transport of revision 2025-11-25 at /mcp, a
/// JSON answer to each POST. There is nothing to say unasked, so GET, which would open a stream, is
/// refused by 405. `initialize` begins a session (Mcp-Session-Id); DELETE ends it.
/// Lifetime: context and server outlive it. Thread: the context's. Limits: those of vm::WebDoor and
/// vm::WebSession; kMaxSessions, beyond which the one that was silent longest ends.
class McpHttp {
 public:
  static constexpr std::size_t kMaxSessions = 64;
  struct Options {
    std::string at;
    std::string token;
    std::vector<std::string> origins;  ///< pages of other sites that may come
    std::function<void(const std::string& text)> on_refusal;
  };
  /// Throws std::runtime_error where it cannot serve.
  McpHttp(boost::asio::io_context& io, Options options, McpServer& server);
  ~McpHttp();
  McpHttp(const McpHttp&) = delete;
  /// "127.0.0.1:8091"
  std::string host() const;

 private:
  const std::shared_ptr<vm::WebSite> site_;
};

}  // namespace gateway
