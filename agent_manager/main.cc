// agent_manager: the hub. Reads a configuration, starts the modules, routes what they say.

#include <malloc.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "agent_manager/agent_manager.h"
#include "agent_manager/config/am_conf.h"
#include "vm_protocol/core/text_file.h"

namespace {

constexpr std::size_t kMaxFileBytes = 16u << 20;  // a configuration, lines for the console

/// Left to itself glibc raises both limits to the largest block ever freed, and what a flood once
/// needed is never given back.
void GiveBackMemory() {
#ifdef __GLIBC__
  constexpr int kBytes = 128 << 10;
  mallopt(M_MMAP_THRESHOLD, kBytes);
  mallopt(M_TRIM_THRESHOLD, kBytes);
#endif
}

/// The usual soft limit, 1024, is less than the peers we may have; TLS takes three for each.
void RaiseDescriptorLimit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  constexpr rlim_t kWanted = 65536;
  limit.rlim_cur = std::min(limit.rlim_max, std::max(limit.rlim_cur, kWanted));
  setrlimit(RLIMIT_NOFILE, &limit);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Galatea agent manager: starts the modules and carries what they say to each other",
               "agent_manager");
  std::string config_path, log, clock, replay, do_file;
  std::string web, web_role;
  bool no_console = false;
  am::AgentManager::Options options;
  app.add_option("--config,-C", config_path,
                 "Configuration (JSON, or the original's am.conf; docs/configuration.md)");
  app.add_option("--log", log, "Write every message to this file");
  app.add_option("--clock", clock, "real or virtual (overrides the configuration)")
      ->check(CLI::IsMember({"real", "virtual"}));
  app.add_option("--web", web, "Serve the page on this port of this machine (0: any free one)")
      ->check(CLI::Range(0, 65535));
  app.add_option("--web-role", web_role,
                 "What those who open the page may do: guest (default), client, module or owner "
                 "(docs/security.md)")
      ->check(CLI::IsMember({"guest", "client", "module", "owner"}));
  app.add_option("--do", do_file, "Lines the console says first");
  app.add_option("--replay", replay, "Say again what clients said in this session log");
  app.add_option("--speed", options.replay_speed, "How many times faster to replay")
      ->check(CLI::Range(0.01, 1000.0));
  app.add_flag("--no-console", no_console, "Do not read stdin; run until told to exit");
  app.add_flag("--serve", options.serve, "Go on after the end of stdin");
  app.add_flag("--strict", options.strict, "End with exit code 1 if any error was seen");
  bool slots_markdown = false;
  app.add_flag("--slots-markdown", slots_markdown, "Print the tables of slots and end");
  app.set_version_flag("--version", "agent_manager (Galatea) " GALATEA_VERSION);
  CLI11_PARSE(app, argc, argv);
  std::signal(SIGPIPE, SIG_IGN);
  GiveBackMemory();
  RaiseDescriptorLimit();
  try {
    const auto read_config = [&]() -> vm::Result<am::Config> {
      am::Config config;
      if (!config_path.empty()) {
        const std::string folder = std::filesystem::path(config_path).parent_path().string();
        const auto text = vm::ReadTextFile(config_path, kMaxFileBytes);
        if (!text) return std::unexpected(text.error());
        auto parsed = am::IsAmConf(*text)
                          ? am::ParseAmConf(*text, config_path)
                          : am::ParseConfig(*text, config_path, folder.empty() ? "." : folder);
        if (!parsed) return parsed;
        config = std::move(*parsed);
      }
      if (!log.empty()) config.log.file = log;
      if (!web.empty()) config.web.at = "tcp:127.0.0.1:" + web;
      for (const am::Role role : am::kRoles) {
        if (web_role == am::RoleName(role)) config.web.role = role;
      }
      if (!clock.empty()) config.virtual_clock = clock == "virtual";
      return config;
    };
    auto config = read_config();
    if (!config) throw std::runtime_error(config.error().text);
    if (!config_path.empty()) options.read_config = read_config;
    options.console = !no_console;
    if (!replay.empty()) options.replay = replay;
    if (!do_file.empty()) {
      const auto text = vm::ReadTextFile(do_file, kMaxFileBytes);
      if (!text) throw std::runtime_error(text.error().text);
      std::istringstream lines(*text);
      for (std::string line; std::getline(lines, line);) options.first_lines.push_back(line);
    }
    am::AgentManager hub(std::move(*config), options);
    if (slots_markdown) {
      std::cout << hub.SlotsMarkdown();
      return 0;
    }
    return hub.Run();
  } catch (const std::exception& error) {
    std::cerr << "agent_manager: " << error.what() << std::endl;
    return 1;
  }
}
