#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "vm_protocol/web/door.h"
#include "vm_protocol/web/visitors.h"

namespace vm {

/// What the connections of one web server share.
struct WebSite {
  using Headers = std::map<std::string, std::string>;
  WebSite(WebVisitors who, std::function<void(const std::string& text)> tell)
      : visitors(std::move(who)), on_refusal(std::move(tell)) {}
  const WebVisitors visitors;
  const std::function<void(const std::string& text)> on_refusal;
  /// What pages of named sites may use beside what needs no leave.
  std::string methods = "POST";
  std::string headers = "authorization, content-type";
  Headers of_every_answer{};
  std::size_t max_body_bytes = 64u << 10;
  std::optional<WebDoor> door;
  bool closed = false;
};

/// One connection: reads requests one after the other and answers those that may not come; what
/// showed the token is the derived class's.
/// Lifetime: kept alive by its pending operation. Thread: the context's. Limits: kMaxHeaderBytes,
/// WebSite::max_body_bytes, kRequestLimit for a request.
class WebSession : public std::enable_shared_from_this<WebSession> {
 public:
  static constexpr std::size_t kMaxHeaderBytes = 8192;

  WebSession(std::shared_ptr<WebSite> site, boost::asio::ip::tcp::socket socket)
      : site_(std::move(site)), stream_(std::move(socket)) {
    place_.emplace(*site_->door);
  }
  virtual ~WebSession() = default;
  WebSession(const WebSession&) = delete;

  /// Enters the list of connections without the token, and reads the first request.
  void Begin();

 protected:
  using Status = boost::beast::http::status;
  using Headers = WebSite::Headers;
  /// Answers request(), now or later, by one call of Reply or Refuse, or takes the stream.
  virtual void Route() = 0;
  /// What is said of a refusal: a type and a body.
  virtual std::pair<std::string, std::string> ErrorBody(Status status,
                                                        const std::string& what) const = 0;
  virtual bool HasToken() const { return site_->visitors.HasToken(request_); }
  /// Whether the request shows a token at all, be it a wrong one.
  virtual bool ShowsSomeToken() const;

  const WebRequest& request() const { return request_; }
  std::string Header(std::string_view name) const { return std::string(request_[name]); }
  /// The address up to `?`.
  std::string Path() const;
  std::string_view Target() const { return {request_.target().data(), request_.target().size()}; }
  bool closed() const { return site_->closed; }
  /// The answer takes as long as it takes. A client that goes meanwhile, or sends more than fits
  /// our buffer, frees its place at once, and `on_gone` is called: nobody waits for the answer.
  void WaitForAnswer(std::function<void()> on_gone);
  boost::beast::tcp_stream TakeStream();
  /// Without effect once the client has gone.
  void Reply(Status status, std::string_view type, std::string body, const Headers& more = {});
  /// `what` is also logged; `advice` is for the client alone.
  void Refuse(Status status, const std::string& what, const std::string& advice = "");

 private:
  void Read();
  void Drop();
  void OnHead(const boost::system::error_code& error);
  void ReadBody();
  void OnRead(const boost::system::error_code& error);
  /// False: it may not, or asked for nothing but leave; that is answered.
  bool MayCome();
  /// True: the reading has failed, and that is answered.
  bool Failed(const boost::system::error_code& error);
  void Watch();
  void Gone();
  void Write(Status status, std::string_view type, std::string body, const Headers& more,
             bool goes_on);

  const std::shared_ptr<WebSite> site_;
  std::optional<WebDoor::Place> place_;
  std::optional<WebDoor::Stranger> stranger_;  // until it has shown the token
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_{2 * kMaxHeaderBytes + site_->max_body_bytes};
  std::optional<boost::beast::http::request_parser<boost::beast::http::string_body>> parser_;
  WebRequest request_;
  boost::beast::http::response<boost::beast::http::string_body> response_;
  std::function<void()> on_gone_;  // while the answer is waited for
};

/// Opens the site's door at `at`; `make` makes the session of a connection. Throws
/// std::runtime_error where it cannot serve.
template <typename Make>
void OpenDoor(boost::asio::io_context& io, const std::string& at,
              const std::shared_ptr<WebSite>& site, Make make) {
  site->door.emplace(
      io, at,
      [weak = std::weak_ptr(site), make](boost::asio::ip::tcp::socket socket) {
        if (weak.lock()) make(std::move(socket))->Begin();
      },
      site->on_refusal);
}

}  // namespace vm
