#pragma once

#include "gateway/face/live_face.h"
#include "gateway/web/gateway_server.h"
#include "gateway/web/http_session.h"

/// What the files of the server share; not for other folders.
namespace gateway {

struct GatewayServer::Impl : HttpSite {
  Impl(boost::asio::io_context& context, GatewayOptions the_options, const vdm::MouthNet& the_net,
       VoiceWorker* the_voice)
      : HttpSite({the_options.token, the_options.origins}, the_options.on_refusal),
        options(std::move(the_options)),
        net(the_net),
        voice(the_voice),
        io(context) {}
  const GatewayOptions options;
  const vdm::MouthNet& net;
  VoiceWorker* const voice;
  boost::asio::io_context& io;
  std::size_t clients = 0;
};

/// Takes over a connection whose request has shown the token: sound in, weights out, until either
/// side ends.
void ServeMouth(std::shared_ptr<GatewayServer::Impl> server, boost::beast::tcp_stream stream,
                const HttpRequest& request, const LiveFace::Settings& settings);

}  // namespace gateway
