#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "agent_manager/config/config.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// The hub's page, for people on this machine who know the token: files built into the program, the
/// live face (/face.mjpg), metrics (/metrics), and a WebSocket (/ws) that speaks the protocol, one
/// line a message, and is a peer like any other.
/// Refused and reported: no or a wrong token, a page of another site (Host, Origin), paths that are
/// none of these, requests over kMaxHeaderBytes, WebSocket messages over a line's length.
/// Thread: the context's. The hub outlives it.
class WebServer {
 public:
  using OnRefusal = std::function<void(const std::string& text)>;
  /// Throws std::runtime_error with a sentence.
  WebServer(boost::asio::io_context& io, const WebConfig& config, Hub& hub,
            std::function<std::string()> metrics, OnRefusal on_refusal);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  /// What to give a browser. Carries the token.
  std::string Address() const;

  struct Impl;

 private:
  std::shared_ptr<Impl> impl_;
};

}  // namespace am
