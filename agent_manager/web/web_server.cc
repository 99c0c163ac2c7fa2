#include "agent_manager/web/web_server.h"

#include <algorithm>
#include <array>
#include <functional>
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
namespace http = boost::beast::http;
using std::string_view;

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

/// One connection: answers its requests one after the other, or hands it to a WebSocket or video.
class PageSession final : public vm::WebSession {
 public:
  PageSession(std::shared_ptr<WebServer::Impl> server, asio::ip::tcp::socket socket)
      : WebSession(server, std::move(socket)), server_(std::move(server)) {}

 private:
  bool HasToken() const override {
    if (WebSession::HasToken()) return true;
    return vm::ShowsToken(ShownCookie().value_or(""), "", server_->visitors.token());
  }
  bool ShowsSomeToken() const override {
    return WebSession::ShowsSomeToken() || ShownCookie().has_value();
  }
  /// The token in the cookie of this page's address; nothing if there is no such cookie.
  std::optional<string_view> ShownCookie() const {
    const std::string name = CookieOf(server_->door->host());
    string_view cookies = vm::WebHeader(request(), http::field::cookie);
    while (!cookies.empty()) {
      const std::size_t end = std::min(cookies.find(';'), cookies.size());
      string_view cookie = cookies.substr(0, end);
      cookies.remove_prefix(std::min(end + 1, cookies.size()));
      while (cookie.starts_with(' ')) cookie.remove_prefix(1);
      if (cookie.starts_with(name)) return cookie.substr(name.size());
    }
    return {};
  }

  void Route() override {
    const std::string path = Path();
    if (request().method() != http::verb::get)
      return Refuse(Status::method_not_allowed, "a method that is not GET");
    for (const auto& [of, module] : {std::pair("/microphone", "SRM"),
                                     {"/face.mjpg", "FSM"},
                                     {"/face", "FSM"},
                                     {"/voice", "SSM"}}) {
      const auto allowed = server_->hub.access().CheckReceiver(server_->role, module);
      if (path == of && !allowed)
        return Refuse(Status::forbidden, path + ": " + allowed.error().text);
    }
    if (path == "/ws") return web::ServeSocket(server_, TakeStream(), request());
    if (path == "/microphone") {
      if (server_->microphone) return Refuse(Status::conflict, "a second microphone");
      return web::ServeMicrophone(server_, TakeStream(), request());
    }
    if (path == "/face") return web::ServeLive(server_, TakeStream(), request(), web::Live::kFace);
    if (path == "/voice")
      return web::ServeLive(server_, TakeStream(), request(), web::Live::kVoice);
    if (path == "/face.mjpg") return web::ServeVideo(server_, TakeStream());
    if (path == "/metrics")
      return Reply(Status::ok, "text/plain; version=0.0.4", server_->metrics());
    for (const File& file : Files()) {
      if (file.path != path) continue;
      // The token moves from the address, which others might read, into a cookie.
      if (vm::WebParameter(Target(), "token"))
        return Reply(Status::see_other, "text/plain", "",
                     {{"Location", path},
                      {"Set-Cookie", CookieOf(server_->door->host()) + server_->visitors.token() +
                                         "; Path=/; HttpOnly; SameSite=Strict"}});
      return Reply(Status::ok, file.type, std::string(file.content()));
    }
    Refuse(Status::not_found, "a request for '" + path.substr(0, 100) + "'");
  }

  std::pair<std::string, std::string> ErrorBody(Status status,
                                                const std::string& what) const override {
    const auto reason = http::obsolete_reason(status);
    return {"text/plain; charset=utf-8",
            std::string(reason.data(), reason.size()) + ": " + what + "\n"};
  }

  const std::shared_ptr<WebServer::Impl> server_;
};

}  // namespace

WebServer::WebServer(asio::io_context& io, const WebConfig& config, Hub& hub,
                     std::function<std::string()> metrics, OnRefusal on_refusal) {
  vm::Credentials credentials;
  credentials.token_file = config.token_file;
  const auto token = vm::ReadToken(credentials);
  if (!token) throw std::runtime_error(token.error().text);
  const auto endpoint = vm::ParseEndpoint(config.at);
  if (!endpoint) throw std::runtime_error(endpoint.error().text);
  // A port that the system chooses is another one next time.
  const std::string shown = !token->empty()       ? *token
                            : endpoint->port == 0 ? vm::MakeNonce()
                                                  : KeptToken(endpoint->port);
  impl_ = std::make_shared<Impl>(
      io, hub, shown,
      [tell = std::move(on_refusal)](const std::string& text) { tell("web page: " + text); });
  impl_->of_every_answer = {{"X-Frame-Options", "DENY"},
                            {"Referrer-Policy", "no-referrer"},
                            {"Content-Security-Policy", "default-src 'self'"}};
  impl_->max_body_bytes = 0;
  impl_->role = config.role;
  impl_->metrics = std::move(metrics);
  impl_->face = std::make_unique<LiveSource>(io, hub, LiveSource::kFace);
  impl_->voice = std::make_unique<LiveSource>(io, hub, LiveSource::kVoice);
  vm::OpenDoor(io, config.at, impl_, [server = std::weak_ptr(impl_)](auto socket) {
    return std::make_shared<PageSession>(server.lock(), std::move(socket));
  });
}

WebServer::~WebServer() {
  impl_->closed = true;
  impl_->door->Close();
  impl_->face.reset();
  impl_->voice.reset();
}

std::string WebServer::Address() const {
  return "http://" + impl_->door->host() + "/?token=" + impl_->visitors.token();
}

}  // namespace am
