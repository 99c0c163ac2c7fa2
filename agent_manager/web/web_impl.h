#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <functional>

#include "agent_manager/web/live_source.h"
#include "agent_manager/web/web_server.h"
#include "vm_protocol/web/session.h"

/// What the files of the web server share; not for other folders.
namespace am {

/// The state of the web server. Each connection shares it and stops when `closed` is set.
struct WebServer::Impl : vm::WebSite {
  Impl(boost::asio::io_context& context, Hub& the_hub, const std::string& token, OnRefusal tell)
      : WebSite({token, {}}, std::move(tell)), io(context), hub(the_hub) {}
  boost::asio::io_context& io;
  Hub& hub;
  Role role = Role::kGuest;  ///< of every peer that connects through the page
  std::function<std::string()> metrics;
  std::unique_ptr<LiveSource> face;
  std::unique_ptr<LiveSource> voice;
  bool microphone = false;  ///< a browser streams its microphone
};

namespace web {

using Request = vm::WebRequest;

// Each takes over a connection whose request has shown the token.

/// Speaks the protocol over a WebSocket until either side ends.
void ServeSocket(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream,
                 const Request& request);
/// Passes the sound of a browser's microphone to the ear until either side ends.
void ServeMicrophone(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream,
                     const Request& request);
/// Sends what is seen of the face or heard of the voice, with its times, over a WebSocket until
/// either side ends.
enum class Live { kFace, kVoice };
void ServeLive(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream,
               const Request& request, Live live);
/// Sends pictures of the face until either side ends.
void ServeVideo(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream);

}  // namespace web
}  // namespace am
