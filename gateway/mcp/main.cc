// Slots as tools over MCP: standard input and output or HTTP to clients, a connection to the hub.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <iostream>
#include <list>
#include <memory>
#include <optional>
#include <stdexcept>

#include "agent_manager/web/page_token.h"
#include "gateway/mcp/mcp_http.h"
#include "gateway/mcp/mcp_server.h"
#include "vm_protocol/core/client.h"
#include "vm_protocol/runtime/acceptor.h"

namespace {

namespace asio = boost::asio;

/// The program: the hub on one side, clients on the other, and the server between them.
/// Thread: the context's.
class Bridge {
 public:
  /// `http`: where clients come; nothing: there is one, at standard input and output.
  Bridge(std::vector<gateway::McpServer::Allowed> allowed, std::chrono::seconds limit,
         std::optional<gateway::McpHttp::Options> http)
      : limit_(limit),
        http_options_(std::move(http)),
        client_([this](std::string_view line) { hub_->Send(line); }),
        server_(std::move(allowed), {.ask = [this](vm::Message message, auto on_answer) {
                  return Ask(std::move(message), std::move(on_answer));
                }}) {}

  /// Returns when the client at standard input says no more and everything is answered, or a signal
  /// ends it. Throws where the hub cannot be had or has gone, or it cannot serve.
  void Run(const vm::Endpoint& hub, const vm::Credentials& credentials) {
    vm::Connect(io_, hub, credentials, vm::Framing::kLf, vm::Encoding::kUtf8,
                [this](vm::Result<std::shared_ptr<vm::StreamPeer>> stream) {
                  if (!stream) return Fail(stream.error().text);
                  Begin(std::move(*stream));
                });
    io_.run();
    if (!failure_.empty()) throw std::runtime_error(failure_);
  }

 private:
  void Begin(std::shared_ptr<vm::StreamPeer> hub) {
    hub_ = std::move(hub);
    hub_->Start(
        [this](vm::Result<std::string_view> line) {
          if (line) client_.HandleLine(*line);
          EndIfDone();
        },
        [this](const vm::StreamEnd& end) { Fail("the hub has gone: " + end.reason); });
    hub_->ResumeReading();
    if (!http_options_) return TalkToStandardStreams();
    http_.emplace(io_, *http_options_, server_);
    std::cout << "http://" << http_->host() << "/mcp?token=" << http_options_->token << std::endl;
    signals_.async_wait([this](const boost::system::error_code&, int) { io_.stop(); });
  }

  void TalkToStandardStreams() {
    model_ = vm::StreamPeer::Make(io_, STDIN_FILENO, STDOUT_FILENO, vm::Framing::kLf);
    model_->HoldInputWhileBehind();
    model_->Start(
        [this](vm::Result<std::string_view> line) {
          // A line that is too long is no message: it is answered as such.
          server_.Handle(line ? *line : std::string_view(),
                         [this](const std::string& answer) { model_->Send(answer); });
        },
        [this](const vm::StreamEnd&) {
          ended_ = true;
          EndIfDone();
        });
  }

  gateway::McpServer::GiveUp Ask(vm::Message message, gateway::McpServer::OnAnswer on_answer) {
    const auto timer = timers_.emplace(timers_.end(), io_);
    const std::string tag = client_.Request(
        std::move(message),
        [this, timer, on_answer = std::move(on_answer)](vm::Result<std::string> answer) {
          timers_.erase(timer);
          on_answer(std::move(answer));
        });
    timer->expires_after(limit_);
    timer->async_wait([this, tag](const boost::system::error_code& stopped) {
      if (stopped) return;
      client_.Abandon(tag, {vm::Errc::kTimeout,
                            "no answer within " + std::to_string(limit_.count()) + " s", 0});
      EndIfDone();
    });
    return [this, tag] {
      client_.Abandon(tag, {vm::Errc::kStopped, "nobody waits for the answer", 0});
    };
  }

  void EndIfDone() {
    if (!model_ || !ended_ || server_.running() > 0) return;
    model_->Flush([this] { io_.stop(); });
  }
  void Fail(const std::string& why) {
    failure_ = why;
    io_.stop();
  }

  asio::io_context io_;
  const std::chrono::seconds limit_;
  const std::optional<gateway::McpHttp::Options> http_options_;
  asio::signal_set signals_{io_, SIGINT, SIGTERM};
  std::list<asio::steady_timer> timers_;
  std::shared_ptr<vm::StreamPeer> hub_, model_;
  vm::Client client_;
  gateway::McpServer server_;
  std::optional<gateway::McpHttp> http_;
  std::string failure_;
  bool ended_ = false;
};

/// What is asked of HTTP clients: the first line of a file, or a token that is kept.
std::string TokenOf(const std::string& at, const std::string& file) {
  vm::Credentials credentials;
  credentials.token_file = file;
  const auto token = vm::ReadToken(credentials);
  if (!token) throw std::runtime_error(token.error().text);
  const auto endpoint = vm::ParseEndpoint(at);
  if (!endpoint) throw std::runtime_error("--http: " + endpoint.error().text);
  if (auto fit = vm::CheckListening(*endpoint, credentials); !fit)
    throw std::runtime_error("--http: " + fit.error().text);
  if (!token->empty()) return *token;
  return endpoint->port == 0 ? vm::MakeNonce() : am::KeptToken(endpoint->port);
}

}  // namespace

int main(int argc, char** argv) {
  std::string hub;
  std::vector<std::string> allow;
  vm::Credentials credentials;
  int limit_s = 60;
  std::string at, http_token_file;
  std::vector<std::string> origins;
  CLI::App app(
      "An agent's slots as tools for language models, by the Model Context Protocol over "
      "standard input and output, or HTTP");
  app.set_version_flag("--version", "mcp (Galatea) " GALATEA_VERSION);
  app.add_option("--connect", hub, "The hub: unix:PATH, tcp:HOST:PORT or tls:HOST:PORT")
      ->required();
  app.add_option(
         "--allow", allow,
         "\"@MODULE SLOT\" that becomes a tool; * stands for any letters of the slot (may be "
         "repeated)")
      ->required();
  app.add_option("--token-file", credentials.token_file, "The hub's token");
  app.add_option("--certificate", credentials.certificate, "PEM: what is shown over TLS");
  app.add_option("--key", credentials.key, "PEM: its key");
  app.add_option("--authority", credentials.authority, "PEM: who signs the hub's certificate");
  app.add_option("--seconds", limit_s, "How long a module may take to answer (60)")
      ->check(CLI::Range(1, 3600));
  auto* const http =
      app.add_option("--http", at, "Serve clients over HTTP at tcp:HOST:PORT, path /mcp");
  app.add_option("--http-token-file", http_token_file,
                 "A file only you can read, whose first line clients must show; without it one is "
                 "made and kept")
      ->needs(http);
  app.add_option("--origin", origins,
                 "A site whose pages may come, https://example.org (may be repeated)")
      ->needs(http);
  CLI11_PARSE(app, argc, argv);
  try {
    std::vector<gateway::McpServer::Allowed> allowed;
    for (const std::string& text : allow) {
      auto one = gateway::ParseAllowed(text);
      if (!one) throw std::runtime_error("--allow: " + one.error().text);
      allowed.push_back(std::move(*one));
    }
    const auto endpoint = vm::ParseEndpoint(hub);
    if (!endpoint) throw std::runtime_error("--connect: " + endpoint.error().text);
    std::optional<gateway::McpHttp::Options> served;
    if (!at.empty()) {
      served = {
          .at = at,
          .token = TokenOf(at, http_token_file),
          .origins = origins,
          .on_refusal = [](const std::string& text) { std::cerr << "mcp: " << text << std::endl; }};
    }
    Bridge(std::move(allowed), std::chrono::seconds(limit_s), std::move(served))
        .Run(*endpoint, credentials);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "mcp: " << error.what() << std::endl;
    return 1;
  }
}
