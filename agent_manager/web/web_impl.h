#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <functional>
#include <list>

#include "agent_manager/web/face_video.h"
#include "agent_manager/web/web_server.h"

/// Shared by the files that make up the web server. Not for others.
namespace am {

struct WebServer::Impl {
  Impl(boost::asio::io_context& context, Hub& the_hub)
      : io(context), acceptor(context), retry(context), hub(the_hub) {}
  boost::asio::io_context& io;
  boost::asio::ip::tcp::acceptor acceptor;
  boost::asio::steady_timer retry;  ///< after an accept that failed
  Hub& hub;
  Role role = Role::kGuest;  ///< of those who come by the page
  std::string token;
  std::string host;  ///< "127.0.0.1:8080"
  std::function<std::string()> metrics;
  OnRefusal on_refusal;
  std::unique_ptr<FaceVideo> video;
  std::size_t connections = 0;
  /// Connections that have not shown the token yet, the oldest first; each ends its own.
  std::list<std::function<void()>> strangers;
  bool starved = false;  ///< the last accept failed
  bool closed = false;
  bool microphone = false;  ///< somebody's is being listened to
};

namespace web {

using Request = boost::beast::http::request<boost::beast::http::empty_body>;

/// Speaks the protocol over a WebSocket until either side ends. Has been let in already.
void ServeSocket(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream,
                 const Request& request);
/// Hands a browser's microphone to the ear until either side ends. Has been let in already.
void ServeMicrophone(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream,
                     const Request& request);
/// Sends pictures of the face until either side ends.
void ServeVideo(std::shared_ptr<WebServer::Impl> server, boost::beast::tcp_stream stream);

}  // namespace web
}  // namespace am
