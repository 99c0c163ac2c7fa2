#include "vm_protocol/web/door.h"

#include <boost/asio/buffer.hpp>
#include <stdexcept>
#include <utility>

namespace vm {
namespace {

using boost::asio::ip::tcp;

constexpr std::size_t kBeingDropped = 8;  // dropped connections whose last operation is pending

void TurnAway(tcp::socket& socket) {
  constexpr std::string_view kAnswer =
      "HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
  boost::system::error_code ignored;
  socket.non_blocking(true, ignored);
  socket.write_some(boost::asio::buffer(kAnswer), ignored);
  socket.shutdown(boost::asio::socket_base::shutdown_send, ignored);
}

}  // namespace

WebDoor::WebDoor(boost::asio::io_context& io, std::string_view at, OnSocket on_socket,
                 OnTrouble on_trouble)
    : on_socket_(std::move(on_socket)), on_trouble_(std::move(on_trouble)) {
  auto endpoint = ParseEndpoint(at);
  if (!endpoint) throw std::runtime_error(endpoint.error().text);
  if (endpoint->kind != Endpoint::Kind::kTcp)
    throw std::runtime_error("found '" + std::string(at) + "', expected tcp:HOST:PORT");
  if (endpoint->host == "localhost") endpoint->host = "127.0.0.1";
  const auto protocol = endpoint->host.find(':') == std::string::npos ? tcp::v4() : tcp::v6();
  listener_ = Listener::Open(
      io, *endpoint,
      [this, &io, protocol](int fd, const std::string&) { Enter(tcp::socket(io, protocol, fd)); },
      on_trouble_);
  host_ = FormatEndpoint(listener_->endpoint()).substr(std::string_view("tcp:").size());
}

void WebDoor::Enter(tcp::socket socket) {
  if (taken_ >= kMaxConnections && !strangers_.empty()) {
    const auto drop = strangers_.front();
    drop();
  }
  if (taken_ < kMaxConnections + kBeingDropped) {
    full_ = false;
    return on_socket_(std::move(socket));
  }
  TurnAway(socket);
  if (!std::exchange(full_, true))
    on_trouble_("more than " + std::to_string(kMaxConnections) + " connections");
}

}  // namespace vm
