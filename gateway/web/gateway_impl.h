#pragma once

#include <optional>

#include "gateway/face/live_face.h"
#include "gateway/pictures/face_pictures.h"
#include "gateway/web/gateway_server.h"
#include "vm_protocol/web/session.h"

/// What the files of the server share; not for other folders.
namespace gateway {

struct GatewayServer::Impl : vm::WebSite {
  Impl(boost::asio::io_context& context, GatewayOptions the_options, const vdm::MouthNet& the_net,
       VoiceWorker* the_voice)
      : vm::WebSite({the_options.token, the_options.origins}, the_options.on_refusal),
        options(std::move(the_options)),
        net(the_net),
        voice(the_voice),
        io(context) {}
  const GatewayOptions options;
  const vdm::MouthNet& net;
  VoiceWorker* const voice;
  boost::asio::io_context& io;
  std::size_t clients = 0, faces = 0;
};

/// What a client's address asks for.
struct MouthWish {
  LiveFace::Settings live;
  std::optional<FacePictures::Settings> pictures{};
};

/// Takes over a connection whose request has shown the token: sound in, weights out, until either
/// side ends.
void ServeMouth(std::shared_ptr<GatewayServer::Impl> server, boost::beast::tcp_stream stream,
                const vm::WebRequest& request, const MouthWish& wish);

}  // namespace gateway
