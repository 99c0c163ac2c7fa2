#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>

#include "agent_manager/config/config.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// Serves the hub's page to browsers on this machine that show the token: files built into the
/// program, the live face (/face, with times; /face.mjpg), the voice's sound (/voice), metrics
/// (/metrics), a WebSocket (/ws) that speaks the protocol with one line a message and is a peer
/// like any other, and one for the sound of a microphone (/microphone).
/// Lifetime: the context, the hub and what the callbacks use outlive it. Thread: the
/// context's. Limits: those of vm::WebDoor. Errors: refused and passed to OnRefusal are requests
/// without the token, from a page of another site (Host, Origin), for an unknown path or over
/// kMaxHeaderBytes, and WebSocket messages longer than a line.
class WebServer {
 public:
  using OnRefusal = std::function<void(const std::string& text)>;
  /// Throws std::runtime_error with a sentence if the token cannot be read or the address is taken.
  WebServer(boost::asio::io_context& io, const WebConfig& config, Hub& hub,
            std::function<std::string()> metrics, OnRefusal on_refusal);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  /// The URL to open in a browser; it contains the token.
  std::string Address() const;

  struct Impl;

 private:
  std::shared_ptr<Impl> impl_;
};

}  // namespace am
