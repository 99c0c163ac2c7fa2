#include "agent_manager/web/web_server.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <optional>
#include <stdexcept>
#include <utility>

#include "agent_manager/web/page_token.h"
#include "agent_manager/web/web_impl.h"
#include "embedded/page_app_js.h"
#include "embedded/page_conversation_js.h"
#include "embedded/page_engineer_js.h"
#include "embedded/page_favicon_svg.h"
#include "embedded/page_galatea_js.h"
#include "embedded/page_index_html.h"
#include "embedded/page_listening_js.h"
#include "embedded/page_microphone_js.h"
#include "embedded/page_microphone_worklet_js.h"
#include "embedded/page_module_html.h"
#include "embedded/page_module_js.h"
#include "embedded/page_pickers_js.h"
#include "embedded/page_playback_js.h"
#include "embedded/page_presence_js.h"
#include "embedded/page_slot_groups_js.h"
#include "embedded/page_style_css.h"
#include "embedded/page_texts_js.h"
#include "embedded/page_timing_js.h"
#include "vm_protocol/runtime/credentials.h"
#include "vm_protocol/runtime/endpoint.h"

namespace am {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using boost::system::error_code;
using std::string_view;

constexpr auto kRequestLimit = std::chrono::seconds(10);
constexpr std::size_t kMaxHeaderBytes = 8192;

/// A browser sends a cookie to every port of a host, so the pages of two hubs need two names.
std::string CookieOf(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  return "galatea_token_" + std::string(host.substr(colon + 1)) + "=";
}

struct File {
  string_view path, type;
  string_view (*content)();
};
constexpr string_view kHtml = "text/html; charset=utf-8",
                      kScript = "text/javascript; charset=utf-8";
/// Every file of the page. Nothing is read from the disk, so no path can leave this table.
const std::array<File, 19>& Files() {
  static const std::array<File, 19> files{{
      {"/", kHtml, embedded::page_index_html},
      {"/app.js", kScript, embedded::page_app_js},
      {"/conversation.js", kScript, embedded::page_conversation_js},
      {"/engineer.js", kScript, embedded::page_engineer_js},
      {"/favicon.svg", "image/svg+xml", embedded::page_favicon_svg},
      {"/galatea.js", kScript, embedded::page_galatea_js},
      {"/index.html", kHtml, embedded::page_index_html},
      {"/listening.js", kScript, embedded::page_listening_js},
      {"/microphone.js", kScript, embedded::page_microphone_js},
      {"/microphone_worklet.js", kScript, embedded::page_microphone_worklet_js},
      {"/module.html", kHtml, embedded::page_module_html},
      {"/module.js", kScript, embedded::page_module_js},
      {"/pickers.js", kScript, embedded::page_pickers_js},
      {"/playback.js", kScript, embedded::page_playback_js},
      {"/presence.js", kScript, embedded::page_presence_js},
      {"/slot_groups.js", kScript, embedded::page_slot_groups_js},
      {"/style.css", "text/css; charset=utf-8", embedded::page_style_css},
      {"/texts.js", kScript, embedded::page_texts_js},
      {"/timing.js", kScript, embedded::page_timing_js},
  }};
  return files;
}

string_view View(beast::string_view text) { return {text.data(), text.size()}; }

/// One connection: answers its requests one after the other, or hands it to a WebSocket or video.
/// Lifetime: kept alive by its pending operation. Thread: the context's.
/// Limits: kRequestLimit for a request of kMaxHeaderBytes without a body.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(std::shared_ptr<WebServer::Impl> server, asio::ip::tcp::socket socket)
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
    parser_->body_limit(0);
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
    const std::size_t mark = target.find('?');
    const std::string path(target.substr(0, mark));
    // DNS rebinding: a site whose name resolves to our address sends its own name as the host.
    if (View(request_[http::field::host]) != server_->door->host() &&
        View(request_[http::field::host]) != LocalName())
      return Refuse(http::status::misdirected_request, "a request for another host");
    if (request_.method() != http::verb::get)
      return Refuse(http::status::method_not_allowed, "a method that is not GET");
    const bool by_address =
        HasToken(mark == string_view::npos ? "" : target.substr(mark + 1), '&', "token=");
    if (!by_address &&
        !HasToken(View(request_[http::field::cookie]), ';', CookieOf(server_->door->host())) &&
        !HasToken(View(request_[http::field::authorization]), ';', "Bearer "))
      return Refuse(http::status::unauthorized, "a request without the token");
    stranger_.reset();
    for (const auto& [of, module] : {std::pair("/microphone", "SRM"),
                                     {"/face.mjpg", "FSM"},
                                     {"/face", "FSM"},
                                     {"/voice", "SSM"}}) {
      const auto allowed = server_->hub.access().CheckReceiver(server_->role, module);
      if (path == of && !allowed)
        return Refuse(http::status::forbidden, path + ": " + allowed.error().text);
    }
    if (path == "/ws" || path == "/microphone" || path == "/face" || path == "/voice")
      return Upgrade(path);
    if (path == "/face.mjpg") return web::ServeVideo(server_, std::move(stream_));
    if (path == "/metrics")
      return Reply(http::status::ok, "text/plain; version=0.0.4", server_->metrics());
    for (const File& file : Files()) {
      if (file.path != path) continue;
      if (by_address) return ToWithoutToken(path);
      return Reply(http::status::ok, file.type, std::string(file.content()));
    }
    Refuse(http::status::not_found, "a request for '" + path.substr(0, 100) + "'");
  }

  /// Moves the token from the address, which others might read, into a cookie.
  void ToWithoutToken(const std::string& path) {
    auto response = Make(http::status::see_other, "text/plain", "");
    response.set(http::field::location, path);
    response.set(http::field::set_cookie, CookieOf(server_->door->host()) + server_->token +
                                              "; Path=/; HttpOnly; SameSite=Strict");
    Write(std::move(response));
  }

  void Upgrade(const std::string& path) {
    const std::string origin(View(request_[http::field::origin]));
    if (!origin.empty() && origin != "http://" + server_->door->host() &&
        origin != "http://" + LocalName())
      return Refuse(http::status::forbidden, "a WebSocket from the site " + origin.substr(0, 100));
    if (path == "/microphone" && server_->microphone)
      return Refuse(http::status::conflict, "a second microphone");
    stream_.expires_never();
    if (path == "/microphone") return web::ServeMicrophone(server_, std::move(stream_), request_);
    if (path == "/face")
      return web::ServeLive(server_, std::move(stream_), request_, web::Live::kFace);
    if (path == "/voice")
      return web::ServeLive(server_, std::move(stream_), request_, web::Live::kVoice);
    web::ServeSocket(server_, std::move(stream_), request_);
  }

  std::string LocalName() const {
    return "localhost" + server_->door->host().substr(server_->door->host().rfind(':'));
  }

  /// Returns true if one of the parts of `text`, separated by `between`, is `name` and the token.
  bool HasToken(string_view text, char between, string_view name) const {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find(between), text.size());
      string_view part = text.substr(0, end);
      text.remove_prefix(std::min(end + 1, text.size()));
      while (part.starts_with(' ')) part.remove_prefix(1);
      if (part.starts_with(name) &&
          vm::SameProof(std::string(part.substr(name.size())), server_->token))
        return true;
    }
    return false;
  }

  http::response<http::string_body> Make(http::status status, string_view type, std::string body) {
    http::response<http::string_body> response(status,
                                               request_.version() == 0 ? 11 : request_.version());
    response.set(http::field::server, "Galatea");
    response.set(http::field::content_type, std::string(type));
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("X-Frame-Options", "DENY");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Content-Security-Policy", "default-src 'self'");
    response.body() = std::move(body);
    response.prepare_payload();
    return response;
  }

  void Reply(http::status status, string_view type, std::string body) {
    auto response = Make(status, type, std::move(body));
    response.keep_alive(request_.keep_alive());
    Write(std::move(response));
  }

  void Refuse(http::status status, const std::string& what) {
    error_code ignored;
    const auto from = stream_.socket().remote_endpoint(ignored);
    server_->on_refusal("web page: refused " + what + " from " + from.address().to_string());
    Write(Make(status, "text/plain; charset=utf-8",
               std::string(View(http::obsolete_reason(status))) + "\n"));
  }

  void Write(http::response<http::string_body> response) {
    const bool again = response.keep_alive() && response.result() == http::status::ok;
    if (!again) response.keep_alive(false);
    response_ = std::move(response);
    http::async_write(stream_, response_,
                      [self = shared_from_this(), again](const error_code& error, std::size_t) {
                        if (error || self->server_->closed) return;
                        if (again) return self->Read();
                        error_code ignored;
                        self->stream_.socket().shutdown(asio::socket_base::shutdown_send, ignored);
                      });
  }

  const std::shared_ptr<WebServer::Impl> server_;
  const vm::WebDoor::Place place_;
  std::optional<vm::WebDoor::Stranger> stranger_;  // until it has shown the token
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kMaxHeaderBytes * 2};
  std::optional<http::request_parser<http::empty_body>> parser_;
  web::Request request_;
  http::response<http::string_body> response_;
};

}  // namespace

WebServer::WebServer(asio::io_context& io, const WebConfig& config, Hub& hub,
                     std::function<std::string()> metrics, OnRefusal on_refusal)
    : impl_(std::make_shared<Impl>(io, hub)) {
  vm::Credentials credentials;
  credentials.token_file = config.token_file;
  const auto token = vm::ReadToken(credentials);
  if (!token) throw std::runtime_error(token.error().text);
  impl_->role = config.role;
  impl_->metrics = std::move(metrics);
  impl_->on_refusal = std::move(on_refusal);
  impl_->face = std::make_unique<LiveSource>(io, hub, LiveSource::kFace);
  impl_->voice = std::make_unique<LiveSource>(io, hub, LiveSource::kVoice);
  const auto endpoint = vm::ParseEndpoint(config.at);
  if (!endpoint) throw std::runtime_error(endpoint.error().text);
  // A port that the system chooses is another one next time.
  impl_->token = !token->empty()       ? *token
                 : endpoint->port == 0 ? vm::MakeNonce()
                                       : KeptToken(endpoint->port);
  impl_->door.emplace(
      io, config.at,
      [server = std::weak_ptr(impl_)](asio::ip::tcp::socket socket) {
        if (const auto impl = server.lock())
          std::make_shared<HttpSession>(impl, std::move(socket))->Begin();
      },
      [server = impl_.get()](const std::string& text) { server->on_refusal("web page: " + text); });
}

WebServer::~WebServer() {
  impl_->closed = true;
  impl_->door->Close();
  impl_->face.reset();
  impl_->voice.reset();
}

std::string WebServer::Address() const {
  return "http://" + impl_->door->host() + "/?token=" + impl_->token;
}

}  // namespace am
