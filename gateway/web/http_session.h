#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "gateway/web/visitors.h"
#include "vm_protocol/runtime/web_door.h"

namespace gateway {

/// What the connections of one server share. `methods` and `headers`: what pages of named sites may
/// use beside those that need no leave.
struct HttpSite {
  HttpSite(Visitors who, std::function<void(const std::string& text)> tell)
      : visitors(std::move(who)), on_refusal(std::move(tell)) {}
  const Visitors visitors;
  const std::function<void(const std::string& text)> on_refusal;
  std::string methods = "POST";
  std::string headers = "authorization, content-type";
  std::optional<vm::WebDoor> door;
  bool closed = false;
};

/// One connection: reads requests one after the other and answers those that may not come; what
/// showed the token is the derived class's.
/// Lifetime: kept alive by its pending operation. Thread: the context's. Limits: kMaxHeaderBytes,
/// kMaxBodyBytes, kRequestLimit for a request.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  static constexpr std::size_t kMaxHeaderBytes = 8192;
  static constexpr std::size_t kMaxBodyBytes = 64u << 10;

  HttpSession(std::shared_ptr<HttpSite> site, boost::asio::ip::tcp::socket socket)
      : site_(std::move(site)), place_(*site_->door), stream_(std::move(socket)) {}
  virtual ~HttpSession() = default;
  HttpSession(const HttpSession&) = delete;

  /// Enters the list of connections without the token, and reads the first request.
  void Begin();

 protected:
  using Status = boost::beast::http::status;
  using Headers = std::map<std::string, std::string>;
  /// Answers request(), now or later, by one call of Reply or Refuse, or takes the stream.
  virtual void Route() = 0;
  /// What is said of a refusal.
  virtual std::string ErrorBody(Status status, const std::string& what) const = 0;

  const HttpRequest& request() const { return request_; }
  std::string Header(std::string_view name) const { return std::string(request_[name]); }
  /// The address up to `?`.
  std::string Path() const;
  std::string_view Target() const { return {request_.target().data(), request_.target().size()}; }
  bool closed() const { return site_->closed; }
  /// The answer takes as long as it takes.
  void WaitForAnswer() { stream_.expires_never(); }
  boost::beast::tcp_stream TakeStream() { return std::move(stream_); }
  void Reply(Status status, std::string_view type, std::string body, const Headers& more = {});
  void Refuse(Status status, const std::string& what);

 private:
  void Read();
  void Drop();
  void OnRead(const boost::system::error_code& error);
  void Answer();
  void Write(Status status, std::string_view type, std::string body, const Headers& more,
             bool goes_on);

  const std::shared_ptr<HttpSite> site_;
  const vm::WebDoor::Place place_;
  std::optional<vm::WebDoor::Stranger> stranger_;  // until it has shown the token
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_{kMaxHeaderBytes + kMaxBodyBytes};
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  HttpRequest request_;
  boost::beast::http::response<boost::beast::http::string_body> response_;
};

/// Opens the site's door at `at`; `make` makes the session of a connection. Throws
/// std::runtime_error where it cannot serve.
template <typename Make>
void OpenDoor(boost::asio::io_context& io, const std::string& at,
              const std::shared_ptr<HttpSite>& site, Make make) {
  site->door.emplace(
      io, at,
      [weak = std::weak_ptr(site), make](boost::asio::ip::tcp::socket socket) {
        if (weak.lock()) make(std::move(socket))->Begin();
      },
      site->on_refusal);
}

}  // namespace gateway
