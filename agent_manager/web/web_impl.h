#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>

#include "agent_manager/web/face_video.h"
#include "agent_manager/web/web_server.h"

/// Shared by the files that make up the web server. Not for others.
namespace am {

struct WebServer::Impl {
  Impl(boost::asio::io_context& context, Hub& the_hub)
      : io(context), acceptor(context), hub(the_hub) {}
  boost::asio::io_context& io;
  boost::asio::ip::tcp::acceptor acceptor;
  Hub& hub;
  std::string token;
  std::string host;  ///< "127.0.0.1:8080"
  std::function<std::string()> metrics;
  OnRefusal on_refusal;
  std::unique_ptr<FaceVideo> video;
  std::size_t connections = 0;
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
