#pragma once

#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gateway/speech/voice_worker.h"

namespace gateway {

struct GatewayOptions {
  std::string at = "tcp:127.0.0.1:8090";
  std::string token;                 ///< whoever comes must show it
  std::vector<std::string> origins;  ///< pages of other sites that may come, "https://example.org"
  std::size_t clients = 16;          ///< WebSockets at a time
  std::size_t faces = 2;             ///< of these, so many with pictures
  std::vector<std::string> face_command{};  ///< starts the face program; empty: no pictures
  std::function<void(const std::string& text)> on_refusal;
};

/// Serves programs that show the token: a mouth for their sound over a WebSocket (/v1/mouth), and
/// POST /v1/audio/speech (docs/gateway.md). Lifetime: context, network and voice outlive it.
/// Thread: the context's. Limits: those of vm::WebDoor and vm::WebSession, options.clients.
/// Errors: refused with a status and told on_refusal.
class GatewayServer {
 public:
  /// `voice` may be null: then there is no speech. Throws std::runtime_error where it cannot serve.
  GatewayServer(boost::asio::io_context& io, GatewayOptions options, const vdm::MouthNet& net,
                VoiceWorker* voice);
  ~GatewayServer();
  GatewayServer(const GatewayServer&) = delete;
  /// "127.0.0.1:8090"
  std::string host() const;

  struct Impl;

 private:
  const std::shared_ptr<Impl> impl_;
};

}  // namespace gateway
