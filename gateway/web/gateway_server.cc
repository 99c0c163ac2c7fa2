#include "gateway/web/gateway_server.h"

#include <algorithm>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "gateway/speech/speech_request.h"
#include "gateway/web/gateway_impl.h"
#include "vm_protocol/runtime/credentials.h"

namespace gateway {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;
using std::string_view;

constexpr auto kRequestLimit = std::chrono::seconds(10);
constexpr std::size_t kMaxHeaderBytes = 8192;
constexpr std::size_t kMaxBodyBytes = 64u << 10;

string_view View(beast::string_view text) { return {text.data(), text.size()}; }

/// The value of a parameter behind the `?` of an address; nothing if it is not there.
std::optional<string_view> Parameter(string_view target, string_view name) {
  string_view rest = target.substr(std::min(target.find('?'), target.size()));
  while (!rest.empty()) {
    rest.remove_prefix(1);
    const string_view part = rest.substr(0, rest.find('&'));
    rest.remove_prefix(part.size());
    if (part.starts_with(name) && part.substr(name.size()).starts_with('=')) {
      return part.substr(name.size() + 1);
    }
  }
  return {};
}

vm::Result<LiveFace::Settings> SettingsOf(string_view target) {
  const auto number = [target](string_view name, long otherwise) {
    const auto text = Parameter(target, name);
    if (!text) return otherwise;
    long value = -1;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
    return error == std::errc() && end == text->data() + text->size() ? value : -1;
  };
  const auto set = WeightSets::Built().Find(Parameter(target, "set").value_or("visemes22"));
  if (!set) return std::unexpected(set.error());
  const long rate = number("rate", 16'000), fps = number("fps", 50);
  if (auto good = CheckLive(rate, fps); !good) return std::unexpected(good.error());
  return LiveFace::Settings{
      .set = *set, .rate_hz = static_cast<unsigned>(rate), .fps = static_cast<unsigned>(fps)};
}

http::status StatusOf(vm::Errc code) {
  switch (code) {
    case vm::Errc::kSyntax:
    case vm::Errc::kBadValue:
    case vm::Errc::kBadUtf8:
      return http::status::bad_request;
    case vm::Errc::kTooLong:
      return http::status::payload_too_large;
    case vm::Errc::kLimit:
    case vm::Errc::kBusy:
      return http::status::too_many_requests;
    case vm::Errc::kTimeout:
      return http::status::gateway_timeout;
    default:
      return http::status::service_unavailable;
  }
}

/// One connection: answers its requests one after the other, or hands it to a WebSocket.
/// Lifetime: kept alive by its pending operation. Thread: the context's.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(std::shared_ptr<GatewayServer::Impl> server, asio::ip::tcp::socket socket)
      : server_(std::move(server)), place_(*server_->door), stream_(std::move(socket)) {}
  HttpSession(const HttpSession&) = delete;

  /// Enters the list of connections without the token, and reads the first request.
  void Begin() {
    stranger_.emplace(*server_->door, [weak = weak_from_this()] {
      if (const auto self = weak.lock()) self->Drop();
    });
    Read();
  }

  void Read() {
    parser_.emplace();
    parser_->header_limit(kMaxHeaderBytes);
    parser_->body_limit(kMaxBodyBytes);
    stream_.expires_after(kRequestLimit);
    http::async_read(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](const error_code& error, std::size_t) { self->OnRead(error); });
  }

 private:
  void Drop() {
    stranger_.reset();
    error_code ignored;
    stream_.socket().close(ignored);
  }
  void OnRead(const error_code& error) {
    if (server_->closed || !stream_.socket().is_open()) return;
    if (error == http::error::header_limit || error == http::error::body_limit)
      return Refuse(http::status::payload_too_large, "a request that is too large");
    if (error == http::error::end_of_stream || error == beast::error::timeout) return;
    if (error) return Refuse(http::status::bad_request, "a malformed request: " + error.message());
    request_ = parser_->release();
    Answer();
  }

  void Answer() {
    const string_view target = View(request_.target());
    const std::string path(target.substr(0, target.find('?')));
    // Another site's page may come only where it was named; and a site whose name leads to our
    // address (DNS rebinding) sends its own name as the host.
    const std::string origin(View(request_[http::field::origin]));
    if (!origin.empty() && !IsOwn(origin) && !IsNamed(origin))
      return Refuse(http::status::forbidden, "a page of the site " + origin.substr(0, 100));
    const std::string host(View(request_[http::field::host]));
    if (!IsOwn("http://" + host) && !IsNamed("http://" + host) && !IsNamed("https://" + host))
      return Refuse(http::status::misdirected_request, "a request for another host");
    if (request_.method() == http::verb::options && !origin.empty())
      return Reply(http::status::ok, "text/plain", "");
    if (!HasToken(target)) return Refuse(http::status::unauthorized, "a request without the token");
    stranger_.reset();
    if (path == "/v1/mouth") return ToMouth(target);
    if (path == "/v1/audio/speech") return Speak();
    Refuse(http::status::not_found,
           "a request for '" + path.substr(0, 100) + "'; there are /v1/mouth and /v1/audio/speech");
  }

  void ToMouth(string_view target) {
    if (!beast::websocket::is_upgrade(request_))
      return Refuse(http::status::upgrade_required, "a request to /v1/mouth without a WebSocket");
    const auto settings = SettingsOf(target);
    if (!settings) return Refuse(http::status::bad_request, settings.error().text);
    if (server_->clients >= server_->options.clients) {
      return Refuse(http::status::service_unavailable,
                    "more than " + std::to_string(server_->options.clients) + " clients");
    }
    stream_.expires_never();
    ServeMouth(server_, std::move(stream_), request_, *settings);
  }

  void Speak() {
    if (request_.method() != http::verb::post)
      return Refuse(http::status::method_not_allowed, "a method that is not POST");
    if (server_->voice == nullptr)
      return Refuse(http::status::not_found, "a request for speech; there is no voice");
    auto wanted = ReadSpeechRequest(request_.body());
    if (!wanted) return Refuse(StatusOf(wanted.error().code), wanted.error().text);
    stream_.expires_never();  // the voice has a limit of its own
    const auto done = [self = shared_from_this()](vm::Result<SpeechAnswer> answer) {
      if (self->server_->closed) return;
      if (!answer) return self->Refuse(StatusOf(answer.error().code), answer.error().text);
      self->Reply(http::status::ok, answer->media_type, std::move(answer->body));
    };
    if (auto sent = server_->voice->Speak(std::move(*wanted), done); !sent) {
      Refuse(StatusOf(sent.error().code), sent.error().text);
    }
  }

  bool IsOwn(string_view site) const {
    return site == "http://" + server_->door->host() ||
           site ==
               "http://localhost" + server_->door->host().substr(server_->door->host().rfind(':'));
  }
  bool IsNamed(const std::string& site) const {
    return std::ranges::find(server_->options.origins, site) != server_->options.origins.end();
  }

  /// By a header, or, for browsers' WebSockets, which cannot have one, in the address.
  bool HasToken(string_view target) const {
    const string_view header = View(request_[http::field::authorization]);
    const string_view shown =
        header.starts_with("Bearer ") ? header.substr(7) : Parameter(target, "token").value_or("");
    return vm::SameProof(std::string(shown), server_->options.token);
  }

  http::response<http::string_body> Make(http::status status, string_view type, std::string body) {
    http::response<http::string_body> response(status,
                                               request_.version() == 0 ? 11 : request_.version());
    response.set(http::field::server, "Galatea");
    response.set(http::field::content_type, std::string(type));
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    if (const std::string origin(View(request_[http::field::origin]));
        !origin.empty() && IsNamed(origin)) {
      response.set(http::field::access_control_allow_origin, origin);
      response.set(http::field::access_control_allow_headers, "authorization, content-type");
      response.set(http::field::access_control_allow_methods, "POST");
      response.set(http::field::vary, "Origin");
    }
    response.body() = std::move(body);
    response.prepare_payload();
    return response;
  }

  void Reply(http::status status, string_view type, std::string body) {
    auto response = Make(status, type, std::move(body));
    response.keep_alive(request_.keep_alive());
    Write(std::move(response));
  }

  /// As OpenAI's API tells errors, so that its clients show them.
  void Refuse(http::status status, const std::string& what) {
    error_code ignored;
    const auto from = stream_.socket().remote_endpoint(ignored);
    server_->options.on_refusal("refused " + from.address().to_string() + ": " + what);
    const bool ours = http::to_status_class(status) == http::status_class::server_error;
    const nlohmann::json body{
        {"error", {{"message", what}, {"type", ours ? "server_error" : "invalid_request_error"}}}};
    Write(Make(status, "application/json",
               body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
  }

  void Write(http::response<http::string_body> response) {
    const bool again = response.keep_alive() && response.result() == http::status::ok;
    if (!again) response.keep_alive(false);
    response_ = std::move(response);
    stream_.expires_after(kRequestLimit);
    http::async_write(stream_, response_,
                      [self = shared_from_this(), again](const error_code& error, std::size_t) {
                        if (error || self->server_->closed) return;
                        if (again) return self->Read();
                        error_code ignored;
                        self->stream_.socket().shutdown(asio::socket_base::shutdown_send, ignored);
                      });
  }

  const std::shared_ptr<GatewayServer::Impl> server_;
  const vm::WebDoor::Place place_;
  std::optional<vm::WebDoor::Stranger> stranger_;  // until it has shown the token
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kMaxHeaderBytes + kMaxBodyBytes};
  std::optional<http::request_parser<http::string_body>> parser_;
  HttpRequest request_;
  http::response<http::string_body> response_;
};

}  // namespace

GatewayServer::GatewayServer(asio::io_context& io, GatewayOptions options, const vdm::MouthNet& net,
                             VoiceWorker* voice)
    : impl_(std::make_shared<Impl>(io, std::move(options), net, voice)) {
  impl_->door.emplace(
      io, impl_->options.at,
      [server = std::weak_ptr(impl_)](asio::ip::tcp::socket socket) {
        if (const auto impl = server.lock())
          std::make_shared<HttpSession>(impl, std::move(socket))->Begin();
      },
      impl_->options.on_refusal);
}

GatewayServer::~GatewayServer() {
  impl_->closed = true;
  impl_->door->Close();
}

std::string GatewayServer::host() const { return impl_->door->host(); }

}  // namespace gateway
