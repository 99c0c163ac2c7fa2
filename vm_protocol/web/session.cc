#include "vm_protocol/web/session.h"

#include <boost/asio/write.hpp>
#include <utility>

#include "vm_protocol/core/lower_case.h"

namespace vm {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;

constexpr auto kRequestLimit = std::chrono::seconds(10);
constexpr std::size_t kWatchedBytes = 1024;  // read at a time while an answer is waited for
constexpr const char* kWhereTheTokenIs =
    "; the program that serves this prints its address, which ends in ?token=TOKEN, when it "
    "starts: open that address, or send the header 'Authorization: Bearer TOKEN'";
constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";

}  // namespace

void WebSession::Begin() {
  stranger_.emplace(*site_->door, [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->Drop();
  });
  Read();
}

void WebSession::Read() {
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(site_->max_body_bytes);
  stream_.expires_after(kRequestLimit);
  http::async_read_header(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](const error_code& error, std::size_t) { self->OnHead(error); });
}

void WebSession::Drop() {
  stranger_.reset();
  place_.reset();
  error_code ignored;
  stream_.socket().close(ignored);
}

bool WebSession::Failed(const error_code& error) {
  if (site_->closed || !stream_.socket().is_open()) return true;
  if (error == http::error::header_limit || error == http::error::body_limit) {
    Refuse(Status::payload_too_large, "a request that is too large");
  } else if (error && error != http::error::end_of_stream && error != beast::error::timeout) {
    Refuse(Status::bad_request, "a malformed request: " + error.message());
  }
  return error.failed();
}

/// A client that asks whether it may send its body is told before it does; any other has sent it
/// when it hears that it may not come, so that it does not lose the answer by a reset connection.
void WebSession::OnHead(const error_code& error) {
  request_ = {};
  if (Failed(error)) return;
  request_.base() = parser_->get().base();
  const bool asks_first = request_.version() >= 11 && !parser_->is_done() &&
                          LowerCase(Header("Expect")) == "100-continue";
  if (!asks_first) return ReadBody();
  if (!MayCome()) return;
  asio::async_write(stream_, asio::buffer(kContinue),
                    [self = shared_from_this()](const error_code& failed, std::size_t) {
                      if (!failed) self->ReadBody();
                    });
}

void WebSession::ReadBody() {
  http::async_read(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](const error_code& error, std::size_t) { self->OnRead(error); });
}

void WebSession::OnRead(const error_code& error) {
  if (Failed(error)) return;
  request_ = parser_->release();
  if (MayCome()) Route();
}

bool WebSession::MayCome() {
  if (const auto refusal = site_->visitors.CheckSite(request_, site_->door->host())) {
    Refuse(refusal->status, refusal->what);
  } else if (request_.method() == http::verb::options && !Header("Origin").empty()) {
    Reply(Status::ok, "text/plain", "");
  } else if (!HasToken()) {
    Refuse(Status::unauthorized,
           ShowsSomeToken() ? "a request with a wrong token" : "a request without the token",
           kWhereTheTokenIs);
  } else {
    stranger_.reset();
    return true;
  }
  return false;
}

bool WebSession::ShowsSomeToken() const {
  return !Header("Authorization").empty() || WebParameter(Target(), "token");
}

std::string WebSession::Path() const { return std::string(Target().substr(0, Target().find('?'))); }

void WebSession::WaitForAnswer(std::function<void()> on_gone) {
  stream_.expires_never();
  on_gone_ = std::move(on_gone);
  Watch();
}

/// What comes meanwhile is the next request's; only by reading it is the end behind it seen.
void WebSession::Watch() {
  const std::size_t room = std::min(kWatchedBytes, buffer_.max_size() - buffer_.size());
  if (room == 0) return Gone();
  stream_.async_read_some(buffer_.prepare(room),
                          [self = shared_from_this()](const error_code& error, std::size_t bytes) {
                            self->buffer_.commit(bytes);
                            if (!self->on_gone_) return;  // it has been answered
                            if (error) return self->Gone();
                            self->Watch();
                          });
}

void WebSession::Gone() {
  const auto on_gone = std::exchange(on_gone_, nullptr);
  Drop();
  on_gone();
}

beast::tcp_stream WebSession::TakeStream() {
  stream_.expires_never();
  return std::move(stream_);
}

void WebSession::Reply(Status status, std::string_view type, std::string body,
                       const Headers& more) {
  const bool good = http::to_status_class(status) == http::status_class::successful;
  Write(status, type, std::move(body), more, good && request_.keep_alive());
}

void WebSession::Refuse(Status status, const std::string& what, const std::string& advice) {
  error_code ignored;
  const auto from = stream_.socket().remote_endpoint(ignored);
  site_->on_refusal("refused " + what + " from " + from.address().to_string());
  const auto [type, body] = ErrorBody(status, what + advice);
  Headers more;
  if (status == Status::unauthorized) more["WWW-Authenticate"] = "Bearer";
  Write(status, type, body, more, false);
}

void WebSession::Write(Status status, std::string_view type, std::string body, const Headers& more,
                       bool goes_on) {
  if (!stream_.socket().is_open()) return;
  if (std::exchange(on_gone_, nullptr)) stream_.cancel();  // ends the watch
  goes_on = goes_on && parser_->is_done();
  response_ = {status, request_.version() == 0 ? 11 : request_.version()};
  response_.set(http::field::server, "Galatea");
  if (!body.empty() || status == Status::ok)
    response_.set(http::field::content_type, std::string(type));
  response_.set(http::field::cache_control, "no-store");
  response_.set("X-Content-Type-Options", "nosniff");
  for (const auto& [name, value] : site_->of_every_answer) response_.set(name, value);
  for (const auto& [name, value] : more) response_.set(name, value);
  if (const std::string origin = site_->visitors.NamedOrigin(request_); !origin.empty()) {
    response_.set(http::field::access_control_allow_origin, origin);
    response_.set(http::field::access_control_allow_headers, site_->headers);
    response_.set(http::field::access_control_allow_methods, site_->methods);
    response_.set(http::field::access_control_expose_headers, site_->headers);
    response_.set(http::field::vary, "Origin");
  }
  response_.body() = std::move(body);
  response_.prepare_payload();
  response_.keep_alive(goes_on);
  stream_.expires_after(kRequestLimit);
  http::async_write(stream_, response_,
                    [self = shared_from_this(), goes_on](const error_code& error, std::size_t) {
                      if (error || self->site_->closed) return;
                      if (goes_on) return self->Read();
                      error_code ignored;
                      self->stream_.socket().shutdown(asio::socket_base::shutdown_send, ignored);
                    });
}

}  // namespace vm
