// The gateway: options, the network, a voice of its own, and the server over them.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "agent_manager/web/page_token.h"
#include "gateway/web/gateway_server.h"
#include "ssm/process/child_process.h"
#include "vm_protocol/core/spawn.h"
#include "vm_protocol/runtime/credentials.h"
#include "vm_protocol/runtime/endpoint.h"

namespace {

struct Options {
  gateway::GatewayOptions server;
  std::string token_file;
  std::string voices, mask, head;
  std::vector<std::string> voice;
  bool no_voice = false;
  int limit_s = 60;
};

std::string TokenOf(const Options& options) {
  vm::Credentials credentials;
  credentials.token_file = options.token_file;
  const auto token = vm::ReadToken(credentials);
  if (!token) throw std::runtime_error(token.error().text);
  const auto endpoint = vm::ParseEndpoint(options.server.at);
  if (!endpoint) throw std::runtime_error("--at: " + endpoint.error().text);
  if (auto fit = vm::CheckListening(*endpoint, credentials); !fit) {
    throw std::runtime_error("--at: " + fit.error().text);
  }
  if (!token->empty()) return *token;
  // A port that the system chooses is another one next time.
  return endpoint->port == 0 ? vm::MakeNonce() : am::KeptToken(endpoint->port);
}

const vdm::MouthNet& BestNet() {
  return vdm::ShippedNet(vdm::CanMakeFeatures(vdm::FeatureKind::kPhones) ? vdm::FeatureKind::kPhones
                                                                         : vdm::FeatureKind::kMel);
}

bool IsProgram(const std::string& name) {
  if (name.contains('/')) return access(name.c_str(), X_OK) == 0;
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((folder + "/" + name).c_str(), X_OK) == 0) return true;
  return false;
}

/// What a person has misspelt is said now, not to the first client.
void CheckVoice(const std::vector<std::string>& command) {
  if (IsProgram(command.front())) return;
  throw std::runtime_error("--voice: there is no program '" + command.front() +
                           "'; it takes the command of a voice module, to which all words behind "
                           "it belong, so it is the last option");
}

void CheckFace(const std::string& option, const std::string& face) {
  constexpr std::chrono::seconds kLimit{60};  // a head of a file is baked
  const std::vector<std::string> command{vm::ProgramBeside("fsm"), "--describe", option, face};
  if (ssm::RunProgram({.argv = command, .limit = kLimit}, nullptr)) return;
  throw std::runtime_error(option + ": fsm has no such face: '" + face + "' (fsm --describe " +
                           option + " " + face + " says why; its slot MaskSet names the faces)");
}

void Serve(Options& options) {
  std::signal(SIGPIPE, SIG_IGN);
  boost::asio::io_context io;
  options.server.token = TokenOf(options);
  options.server.on_refusal = [](const std::string& text) {
    std::cerr << "gateway: " << text << std::endl;
  };
  std::vector<std::string> command = options.voice;
  if (command.empty()) {
    command = {vm::ProgramBeside("ssm"), "--sink", "null", "--clock", "virtual"};
    if (!options.voices.empty()) command.insert(command.end(), {"--voices", options.voices});
  }
  std::unique_ptr<gateway::VoiceWorker> voice;
  if (!options.no_voice) {
    CheckVoice(command);
    voice = std::make_unique<gateway::VoiceWorker>(
        io, command, std::chrono::seconds(options.limit_s), BestNet());
  }
  if (options.server.faces > 0) {
    options.server.face_command = {vm::ProgramBeside("fsm"), "--headless", "--life", "LIVELY"};
    for (const auto& [name, value] : {std::pair("--mask", options.mask), {"--head", options.head}})
      if (!value.empty()) {
        CheckFace(name, value);
        options.server.face_command.insert(options.server.face_command.end(), {name, value});
      }
  }
  const gateway::GatewayServer server(io, options.server, BestNet(), voice.get());
  std::cout << "ws://" << server.host() << "/v1/mouth?token=" << options.server.token << std::endl;
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  signals.async_wait([&io](const boost::system::error_code&, int) { io.stop(); });
  io.run();
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("The toolkit's mouth and voice for other programs, over WebSocket and HTTP");
  app.set_version_flag("--version", "gateway (Galatea) " GALATEA_VERSION);
  app.add_option("--at", options.server.at, "Where it serves, tcp:HOST:PORT (tcp:127.0.0.1:8090)");
  app.add_option("--token-file", options.token_file,
                 "A file only you can read, whose first line whoever comes must show; without it "
                 "one is made and kept");
  app.add_option("--origin", options.server.origins,
                 "A site whose pages may come, https://example.org (may be repeated)");
  app.add_option("--clients", options.server.clients, "WebSockets at a time (16)")
      ->check(CLI::Range(1, 60));
  app.add_option("--faces", options.server.faces,
                 "WebSockets with pictures at a time, each a face program of its own; 0: none (2)")
      ->check(CLI::Range(0, 16));
  app.add_option("--mask", options.mask, "The face in the pictures (galatea)");
  app.add_option("--head", options.head, "Another head in the pictures: .glb, .vrm, .obj, ...")
      ->check(CLI::ExistingFile);
  app.add_option("--voices", options.voices,
                 "Voices beside flite's, for the voice (docs/speech.md)")
      ->check(CLI::ExistingFile);
  app.add_option("--voice", options.voice,
                 "The command of a voice module in place of ssm; the last option")
      ->expected(1, 64);
  app.add_flag("--no-voice", options.no_voice, "Without /v1/audio/speech");
  app.add_option("--speech-seconds", options.limit_s, "How long a text may take (60)")
      ->check(CLI::Range(1, 600));
  // The words behind --voice are the module's, also those that look like options of ours.
  const auto words = std::span(argv, static_cast<std::size_t>(argc));
  const auto voice = std::ranges::find_if(
      words, [](const char* word) { return word == std::string_view("--voice"); });
  if (words.end() - voice > 1) options.voice.assign(voice + 1, words.end());
  CLI11_PARSE(app, static_cast<int>((options.voice.empty() ? words.end() : voice) - words.begin()),
              argv);
  try {
    Serve(options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "gateway: " << error.what() << std::endl;
    return 1;
  }
}
