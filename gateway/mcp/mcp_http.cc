#include "gateway/mcp/mcp_http.h"

#include <algorithm>
#include <list>
#include <nlohmann/json.hpp>
#include <utility>

#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/http/answer.h"
#include "vm_protocol/runtime/credentials.h"
#include "vm_protocol/web/session.h"

namespace gateway {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;

constexpr const char* kJson = "application/json";
constexpr const char* kSession = "Mcp-Session-Id";
constexpr const char* kRevision = "MCP-Protocol-Version";

/// "application/json; charset=utf-8" is "application/json".
bool IsType(const std::string& header, std::string_view type) {
  std::string name = vm::LowerCase(header.substr(0, header.find(';')));
  while (name.ends_with(' ')) name.pop_back();
  return name == type;
}

/// Whether somebody who accepts that takes JSON.
bool TakesJson(const std::string& accept) {
  for (std::string_view rest = accept; !rest.empty();) {
    const std::string one(rest.substr(0, rest.find(',')));
    rest.remove_prefix(std::min(one.size() + 1, rest.size()));
    const std::string type = one.substr(std::min(one.find_first_not_of(' '), one.size()));
    if (IsType(type, kJson) || IsType(type, "application/*") || IsType(type, "*/*")) return true;
  }
  return accept.empty();
}

struct Site : vm::WebSite {
  Site(McpHttp::Options options, McpServer& the_server)
      : vm::WebSite({std::move(options.token), std::move(options.origins)},
                    std::move(options.on_refusal)),
        server(the_server) {
    methods = "POST, DELETE";
    headers = "authorization, content-type, mcp-session-id, mcp-protocol-version";
  }
  /// A new session's name.
  std::string Open() {
    if (sessions.size() >= McpHttp::kMaxSessions) sessions.pop_front();
    return sessions.emplace_back(vm::MakeNonce());
  }
  /// Whether there is that session; it counts as the last that spoke.
  bool Use(const std::string& name) {
    const auto found = std::ranges::find(sessions, name);
    if (found == sessions.end()) return false;
    sessions.splice(sessions.end(), sessions, found);
    return true;
  }
  McpServer& server;
  std::list<std::string> sessions;  // silent longest first
};

class McpSession final : public vm::WebSession {
 public:
  McpSession(std::shared_ptr<Site> site, asio::ip::tcp::socket socket)
      : vm::WebSession(site, std::move(socket)), site_(std::move(site)) {}

 private:
  void Route() override {
    if (Path() != "/mcp")
      return Refuse(Status::not_found,
                    "a request for '" + Path().substr(0, 100) + "'; there is /mcp");
    const std::string revision = Header(kRevision);
    if (!revision.empty() && !McpServer::Speaks(revision))
      return Refuse(Status::bad_request,
                    "revision '" + revision.substr(0, 40) + "' in " + kRevision);
    if (request().method() == http::verb::post) return Post();
    if (request().method() == http::verb::delete_) return Delete();
    const std::string what = "a method that is neither POST nor DELETE";
    if (request().method() != http::verb::get) return Refuse(Status::method_not_allowed, what);
    // So every client asks whether there is a stream of what is said unasked: nothing to log.
    const auto [type, body] = ErrorBody(Status::method_not_allowed, what);
    Reply(Status::method_not_allowed, type, body, {{"Allow", site_->methods}});
  }

  void Post() {
    if (!IsType(Header("Content-Type"), kJson))
      return Refuse(Status::unsupported_media_type, "a body that is not application/json");
    if (!TakesJson(Header("Accept")))
      return Refuse(Status::not_acceptable, "a client that does not accept application/json");
    const auto message = vm::ParseAnswer(request().body());
    const bool begins = message && message->is_object() &&
                        vm::TextAt(*message, "method") == "initialize" && message->contains("id");
    // What is no message at all is answered as such.
    if (message && !begins && !MayGoOn()) return;
    const auto answered = std::make_shared<bool>(false);
    const auto say = [this, begins, answered, self = shared_from_this()](const std::string& text) {
      *answered = true;
      if (closed()) return;
      Headers more;
      if (begins) more[kSession] = site_->Open();
      Reply(Status::ok, kJson, text, more);
    };
    const auto question = site_->server.Handle(request().body(), say);
    if (!question) return Reply(Status::accepted, kJson, "");
    if (*answered) return;
    WaitForAnswer([site = site_, weak = std::weak_ptr(question)] {
      if (const auto asked = weak.lock()) site->server.Forget(asked);
    });
  }

  void Delete() {
    if (!MayGoOn()) return;
    site_->sessions.remove(Header(kSession));
    Reply(Status::no_content, kJson, "");
  }

  /// False: the request names no session that there is, and has been refused.
  bool MayGoOn() {
    const std::string name = Header(kSession);
    if (name.empty()) {
      Refuse(Status::bad_request, std::string("a request without ") + kSession);
    } else if (!site_->Use(name)) {
      Refuse(Status::not_found, "a session that has ended; initialize begins another");
    } else {
      return true;
    }
    return false;
  }

  std::pair<std::string, std::string> ErrorBody(Status, const std::string& what) const override {
    const nlohmann::json body{{"jsonrpc", "2.0"},
                              {"id", nullptr},
                              {"error", {{"code", -32000}, {"message", "refused: " + what}}}};
    return {kJson, body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
  }

  const std::shared_ptr<Site> site_;
};

}  // namespace

McpHttp::McpHttp(asio::io_context& io, Options options, McpServer& server)
    : site_(std::make_shared<Site>(options, server)) {
  vm::OpenDoor(io, options.at, site_, [site = std::weak_ptr(site_)](auto socket) {
    return std::make_shared<McpSession>(std::static_pointer_cast<Site>(site.lock()),
                                        std::move(socket));
  });
}

McpHttp::~McpHttp() {
  site_->closed = true;
  site_->door->Close();
}

std::string McpHttp::host() const { return site_->door->host(); }

}  // namespace gateway
