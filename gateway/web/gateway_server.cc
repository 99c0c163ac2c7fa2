#include "gateway/web/gateway_server.h"

#include <boost/beast/websocket/rfc6455.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "gateway/speech/speech_request.h"
#include "gateway/web/gateway_impl.h"

namespace gateway {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using std::string_view;

vm::Result<MouthWish> WishOf(string_view target) {
  const auto set = WeightSets::Built().Find(vm::WebParameter(target, "set").value_or("visemes22"));
  if (!set) return std::unexpected(set.error());
  const auto live = ReadLive(vm::WebParameter(target, "rate").value_or("16000"),
                             vm::WebParameter(target, "fps").value_or("50"));
  if (!live) return std::unexpected(live.error());
  MouthWish wish{.live = {.set = *set, .rate_hz = live->rate_hz, .fps = live->fps}};
  if (const auto size = vm::WebParameter(target, "pictures")) {
    const auto pictures =
        ReadPictureSettings(*size, vm::WebParameter(target, "picture_fps").value_or("25"));
    if (!pictures) return std::unexpected(pictures.error());
    wish.pictures = *pictures;
  }
  return wish;
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

/// One connection: answers its requests, or hands it to a WebSocket.
class GatewaySession final : public vm::WebSession {
 public:
  GatewaySession(std::shared_ptr<GatewayServer::Impl> server, asio::ip::tcp::socket socket)
      : vm::WebSession(server, std::move(socket)), server_(std::move(server)) {}

 private:
  void Route() override {
    const std::string path = Path();
    if (path == "/v1/mouth") return ToMouth();
    if (path == "/v1/audio/speech") return Speak();
    Refuse(Status::not_found,
           "a request for '" + path.substr(0, 100) + "'; there are /v1/mouth and /v1/audio/speech");
  }

  void ToMouth() {
    if (!beast::websocket::is_upgrade(request()))
      return Refuse(Status::upgrade_required, "a request to /v1/mouth without a WebSocket");
    const auto wish = WishOf(Target());
    if (!wish) return Refuse(Status::bad_request, wish.error().text);
    const GatewayOptions& options = server_->options;
    if (wish->pictures && (options.face_command.empty() || server_->faces >= options.faces)) {
      return Refuse(Status::service_unavailable,
                    options.face_command.empty()
                        ? "pictures; there is no face"
                        : "more than " + std::to_string(options.faces) + " faces");
    }
    if (server_->clients >= server_->options.clients) {
      return Refuse(Status::service_unavailable,
                    "more than " + std::to_string(server_->options.clients) + " clients");
    }
    ServeMouth(server_, TakeStream(), request(), *wish);
  }

  void Speak() {
    if (request().method() != http::verb::post)
      return Refuse(Status::method_not_allowed, "a method that is not POST");
    if (server_->voice == nullptr)
      return Refuse(Status::not_found, "a request for speech; there is no voice");
    auto wanted = ReadSpeechRequest(request().body());
    if (!wanted) return Refuse(StatusOf(wanted.error().code), wanted.error().text);
    const auto done = [this, self = shared_from_this()](vm::Result<SpeechAnswer> answer) {
      if (closed()) return;
      if (!answer) return Refuse(StatusOf(answer.error().code), answer.error().text);
      Reply(Status::ok, answer->media_type, std::move(answer->body));
    };
    const auto text = server_->voice->Speak(std::move(*wanted), done);
    if (!text) return Refuse(StatusOf(text.error().code), text.error().text);
    // The voice has a limit of its own.
    WaitForAnswer([server = server_, text = *text] { server->voice->Forget(text); });
  }

  /// As OpenAI's API tells errors, so that its clients show them.
  std::pair<std::string, std::string> ErrorBody(Status status,
                                                const std::string& what) const override {
    const bool ours = http::to_status_class(status) == http::status_class::server_error;
    const nlohmann::json body{
        {"error", {{"message", what}, {"type", ours ? "server_error" : "invalid_request_error"}}}};
    return {"application/json",
            body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)};
  }

  const std::shared_ptr<GatewayServer::Impl> server_;
};

}  // namespace

GatewayServer::GatewayServer(asio::io_context& io, GatewayOptions options, const vdm::MouthNet& net,
                             VoiceWorker* voice)
    : impl_(std::make_shared<Impl>(io, std::move(options), net, voice)) {
  vm::OpenDoor(io, impl_->options.at, impl_, [server = std::weak_ptr(impl_)](auto socket) {
    return std::make_shared<GatewaySession>(server.lock(), std::move(socket));
  });
}

GatewayServer::~GatewayServer() {
  impl_->closed = true;
  impl_->door->Close();
}

std::string GatewayServer::host() const { return impl_->door->host(); }

}  // namespace gateway
