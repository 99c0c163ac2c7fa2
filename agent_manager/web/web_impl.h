#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <functional>
#include <optional>

#include "agent_manager/web/live_source.h"
#include "agent_manager/web/web_server.h"
#include "vm_protocol/runtime/web_door.h"

/// What the files of the web server share; not for other folders.
namespace am {

/// The state of the web server. Each connection shares it and stops when `closed` is set.
struct WebServer::Impl {
  Impl(boost::asio::io_context& context, Hub& the_hub) : io(context), hub(the_hub) {}
  boost::asio::io_context& io;
  Hub& hub;
  std::optional<vm::WebDoor> door;
  Role role = Role::kGuest;  ///< of every peer that connects through the page
  std::string token;
  std::function<std::string()> metrics;
  OnRefusal on_refusal;
  std::unique_ptr<LiveSource> face;
  std::unique_ptr<LiveSource> voice;
  bool closed = false;
  bool microphone = false;  ///< a browser streams its microphone
};

namespace web {

using Request = boost::beast::http::request<boost::beast::http::empty_body>;

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
