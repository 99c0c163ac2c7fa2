#include "gateway/web/http_session.h"

namespace gateway {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;

constexpr auto kRequestLimit = std::chrono::seconds(10);

}  // namespace

void HttpSession::Begin() {
  stranger_.emplace(*site_->door, [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->Drop();
  });
  Read();
}

void HttpSession::Read() {
  parser_.emplace();
  parser_->header_limit(kMaxHeaderBytes);
  parser_->body_limit(kMaxBodyBytes);
  stream_.expires_after(kRequestLimit);
  http::async_read(
      stream_, buffer_, *parser_,
      [self = shared_from_this()](const error_code& error, std::size_t) { self->OnRead(error); });
}

void HttpSession::Drop() {
  stranger_.reset();
  error_code ignored;
  stream_.socket().close(ignored);
}

void HttpSession::OnRead(const error_code& error) {
  if (site_->closed || !stream_.socket().is_open()) return;
  if (error == http::error::header_limit || error == http::error::body_limit)
    return Refuse(Status::payload_too_large, "a request that is too large");
  if (error == http::error::end_of_stream || error == beast::error::timeout) return;
  if (error) return Refuse(Status::bad_request, "a malformed request: " + error.message());
  request_ = parser_->release();
  Answer();
}

void HttpSession::Answer() {
  if (const auto refusal = site_->visitors.CheckSite(request_, site_->door->host()))
    return Refuse(refusal->status, refusal->what);
  if (request_.method() == http::verb::options && !request_[http::field::origin].empty())
    return Reply(Status::ok, "text/plain", "");
  if (!site_->visitors.HasToken(request_))
    return Refuse(Status::unauthorized, "a request without the token");
  stranger_.reset();
  Route();
}

std::string HttpSession::Path() const {
  return std::string(Target().substr(0, Target().find('?')));
}

void HttpSession::Reply(Status status, std::string_view type, std::string body,
                        const Headers& more) {
  const bool good = http::to_status_class(status) == http::status_class::successful;
  Write(status, type, std::move(body), more, good && request_.keep_alive());
}

void HttpSession::Refuse(Status status, const std::string& what) {
  error_code ignored;
  const auto from = stream_.socket().remote_endpoint(ignored);
  site_->on_refusal("refused " + from.address().to_string() + ": " + what);
  Write(status, "application/json", ErrorBody(status, what), {}, false);
}

void HttpSession::Write(Status status, std::string_view type, std::string body, const Headers& more,
                        bool goes_on) {
  response_ = {status, request_.version() == 0 ? 11 : request_.version()};
  response_.set(http::field::server, "Galatea");
  if (!body.empty() || status == Status::ok)
    response_.set(http::field::content_type, std::string(type));
  response_.set(http::field::cache_control, "no-store");
  response_.set("X-Content-Type-Options", "nosniff");
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

}  // namespace gateway
