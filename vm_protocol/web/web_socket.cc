#include "vm_protocol/web/web_socket.h"

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <utility>

#include "vm_protocol/core/utf8.h"

namespace vm {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = boost::beast::websocket;

/// Shared with pending operations.
struct WebSocket::Stream : std::enable_shared_from_this<Stream> {
  Stream(beast::tcp_stream stream, Limits the_limits)
      : socket(std::move(stream)), limits(the_limits), write_timer(socket.get_executor()) {}

  void Cut() {
    Error ignored;
    beast::get_lowest_layer(socket).socket().close(ignored);
  }
  void LimitWrite() {
    if (limits.write.count() == 0) return;
    write_timer.expires_after(limits.write);
    write_timer.async_wait([weak = weak_from_this()](const Error& stopped) {
      const auto self = weak.lock();
      if (!stopped && self) self->Cut();
    });
  }

  websocket::stream<beast::tcp_stream, false> socket;  // without compression, which nobody asks for
  const Limits limits;
  asio::steady_timer write_timer;
  beast::flat_buffer buffer;
};

WebSocket::WebSocket(beast::tcp_stream stream, Limits limits)
    : stream_(std::make_shared<Stream>(std::move(stream), limits)) {
  stream_->socket.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
  stream_->socket.read_message_max(limits.message_bytes);
}

WebSocket::~WebSocket() = default;

void WebSocket::Accept(const WebRequest& request, std::string_view protocol, Done done) {
  constexpr auto kProtocol = beast::http::field::sec_websocket_protocol;
  if (!protocol.empty() && request[kProtocol] == protocol) {
    stream_->socket.set_option(websocket::stream_base::decorator(
        [name = std::string(protocol)](websocket::response_type& response) {
          response.set(kProtocol, name);
        }));
  }
  stream_->socket.async_accept(
      request, [stream = stream_, done = std::move(done)](const Error& error) { done(error); });
}

void WebSocket::Read(Received received) {
  stream_->socket.async_read(stream_->buffer, [stream = stream_, received = std::move(received)](
                                                  const Error& error, std::size_t) {
    std::string message = beast::buffers_to_string(stream->buffer.data());
    stream->buffer.consume(stream->buffer.size());
    received(error, std::move(message), stream->socket.got_binary());
  });
}

void WebSocket::Write(std::string_view head, std::string_view body, bool binary, Done done) {
  stream_->LimitWrite();
  stream_->socket.binary(binary);
  const std::array<asio::const_buffer, 2> pieces{asio::buffer(head), asio::buffer(body)};
  stream_->socket.async_write(
      pieces, [stream = stream_, done = std::move(done)](const Error& error, std::size_t) {
        stream->write_timer.cancel();
        done(error);
      });
}

void WebSocket::Close(std::string_view reason, Done done) {
  constexpr std::size_t kReasonBytes = 120;  // Beast takes at most 123
  stream_->socket.async_close(
      {websocket::close_code::try_again_later, CutUtf8(reason, kReasonBytes)},
      [stream = stream_, done = std::move(done)](const Error& error) { done(error); });
}

void WebSocket::Cut() { stream_->Cut(); }

bool WebSocket::IsGoodbye(const Error& error) { return error == websocket::error::closed; }
bool WebSocket::IsTooLong(const Error& error) { return error == websocket::error::message_too_big; }

}  // namespace vm
