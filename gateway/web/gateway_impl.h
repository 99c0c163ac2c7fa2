#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>

#include "gateway/face/live_face.h"
#include "gateway/web/gateway_server.h"

/// What the files of the server share; not for other folders.
namespace gateway {

struct GatewayServer::Impl {
  Impl(boost::asio::io_context& context, GatewayOptions the_options, const vdm::MouthNet& the_net,
       VoiceWorker* the_voice)
      : options(std::move(the_options)),
        net(the_net),
        voice(the_voice),
        io(context),
        acceptor(context),
        retry(context) {}
  const GatewayOptions options;
  const vdm::MouthNet& net;
  VoiceWorker* const voice;
  boost::asio::io_context& io;
  boost::asio::ip::tcp::acceptor acceptor;
  boost::asio::steady_timer retry;  ///< delays the next accept after one that failed
  std::string host;
  std::size_t connections = 0, clients = 0;
  bool closed = false;
};

using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;

/// Takes over a connection whose request has shown the token: sound in, weights out, until either
/// side ends.
void ServeMouth(std::shared_ptr<GatewayServer::Impl> server, boost::beast::tcp_stream stream,
                const HttpRequest& request, const LiveFace::Settings& settings);

}  // namespace gateway
