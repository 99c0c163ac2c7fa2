// agent_manager: the hub. Reads a configuration, starts the modules, routes what they say.

#include <malloc.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <optional>
#include <sstream>

#include "agent_manager/agent_manager.h"
#include "agent_manager/config/am_conf.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/runtime/endpoint.h"

namespace {

constexpr std::size_t kMaxFileBytes = 16u << 20;  // a configuration, lines for the console

/// By default glibc raises both limits to the largest block ever freed, so that memory used during
/// a flood of messages is never returned to the system.
void GiveBackMemory() {
#ifdef __GLIBC__
  constexpr int kBytes = 128 << 10;
  mallopt(M_MMAP_THRESHOLD, kBytes);
  mallopt(M_TRIM_THRESHOLD, kBytes);
#endif
}

/// The usual soft limit, 1024, is too low for the maximum of peers; TLS needs three for each.
void RaiseDescriptorLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  constexpr rlim_t kWanted = 65536;
  limit.rlim_cur = std::min(limit.rlim_max, std::max(limit.rlim_cur, kWanted));
  setrlimit(RLIMIT_NOFILE, &limit);
}

/// The options of the command line.
struct Arguments {
  std::string config, listen, listen_role, log, clock, web, web_role, replay, do_file;
  bool no_console = false;
  bool slots_markdown = false;
  am::AgentManager::Options options{};
};

void AddOptions(CLI::App& app, Arguments& arguments) {
  app.add_option("--config,-C", arguments.config,
                 "Configuration (JSON, or the original's am.conf; docs/configuration.md)");
  auto* listen =
      app.add_option("--listen", arguments.listen,
                     "Another endpoint where clients and modules may come in: unix:PATH or "
                     "tcp:HOST:PORT");
  app.add_option("--listen-role", arguments.listen_role,
                 "What those who come in there may do: guest, client, module or owner (by default "
                 "client on a Unix socket, guest elsewhere; docs/security.md)")
      ->needs(listen)
      ->check(CLI::IsMember({"guest", "client", "module", "owner"}));
  app.add_option("--log", arguments.log, "Write every message to this file");
  app.add_option("--clock", arguments.clock, "real or virtual (overrides the configuration)")
      ->check(CLI::IsMember({"real", "virtual"}));
  app.add_option("--web", arguments.web,
                 "Serve the page on this port of this machine (0: any free one)")
      ->check(CLI::Range(0, 65535));
  app.add_option("--web-role", arguments.web_role,
                 "What those who open the page may do: guest (default), client, module or owner "
                 "(docs/security.md)")
      ->check(CLI::IsMember({"guest", "client", "module", "owner"}));
  app.add_option("--do", arguments.do_file, "Lines the console says first");
  app.add_option("--replay", arguments.replay, "Say again what clients said in this session log");
  app.add_option("--speed", arguments.options.replay_speed, "How many times faster to replay")
      ->check(CLI::Range(0.01, 1000.0));
  app.add_flag("--no-console", arguments.no_console, "Do not read stdin; run until told to exit");
  app.add_flag("--serve", arguments.options.serve, "Go on after the end of stdin");
  app.add_flag("--strict", arguments.options.strict, "End with exit code 1 if any error was seen");
  app.add_flag("--slots-markdown", arguments.slots_markdown, "Print the tables of slots and end");
  app.set_version_flag("--version", "agent_manager (Galatea) " GALATEA_VERSION);
}

vm::Result<am::Config> ReadConfigFile(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const auto text = vm::ReadTextFile(path, kMaxFileBytes);
  if (!text) return std::unexpected(text.error());
  return am::IsAmConf(*text) ? am::ParseAmConf(*text, path)
                             : am::ParseConfig(*text, path, folder.empty() ? "." : folder);
}

/// The role of that name; none: no role is named.
std::optional<am::Role> RoleOf(const std::string& name) {
  for (const am::Role role : am::kRoles) {
    if (name == am::RoleName(role)) return role;
  }
  return std::nullopt;
}

/// Reads the configuration file and applies the options of the command line.
vm::Result<am::Config> ReadConfig(const Arguments& arguments) {
  auto config = arguments.config.empty() ? am::Config{} : ReadConfigFile(arguments.config);
  if (!config) return config;
  if (!arguments.log.empty()) config->log.file = arguments.log;
  if (!arguments.web.empty()) config->web.at = "tcp:127.0.0.1:" + arguments.web;
  config->web.role = RoleOf(arguments.web_role).value_or(config->web.role);
  if (!arguments.listen.empty()) {
    const auto wrong = [](const vm::Error& error) {
      return vm::Fail(error.code, "--listen: " + error.text);
    };
    const auto endpoint = vm::ParseEndpoint(arguments.listen);
    if (!endpoint) return wrong(endpoint.error());
    if (auto can = vm::CheckListening(*endpoint, {}); !can) return wrong(can.error());
    config->listen.push_back({arguments.listen, RoleOf(arguments.listen_role), {}});
  }
  if (!arguments.clock.empty()) config->virtual_clock = arguments.clock == "virtual";
  return config;
}

std::vector<std::string> ReadLines(const std::string& path) {
  const auto text = vm::ReadTextFile(path, kMaxFileBytes);
  if (!text) throw std::runtime_error(text.error().text);
  std::istringstream stream(*text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

int Run(Arguments& arguments) {
  auto config = ReadConfig(arguments);
  if (!config) throw std::runtime_error(config.error().text);
  am::AgentManager::Options& options = arguments.options;
  if (!arguments.config.empty())
    options.read_config = [&arguments] { return ReadConfig(arguments); };
  options.console = !arguments.no_console;
  if (!arguments.replay.empty()) options.replay = arguments.replay;
  if (!arguments.do_file.empty()) options.first_lines = ReadLines(arguments.do_file);
  am::AgentManager hub(std::move(*config), options);
  if (!arguments.slots_markdown) return hub.Run();
  std::cout << hub.SlotsMarkdown();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Galatea agent manager: starts the modules and carries what they say to each other",
               "agent_manager");
  Arguments arguments;
  AddOptions(app, arguments);
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGPIPE, SIG_IGN);
  GiveBackMemory();
  RaiseDescriptorLimit();
  try {
    return Run(arguments);
  } catch (const std::exception& error) {
    std::cerr << "agent_manager: " << error.what() << std::endl;
    return 1;
  }
}
