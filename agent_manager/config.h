#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace am {

/// Whether a module knows tags, @T and the Clock slot. kAuto: the hub finds out by asking for
/// Clock.
enum class Dialect { kAuto, kModern, kOriginal };
enum class Restart { kNever, kOnFailure, kAlways };

struct ModuleConfig {
  std::string name;                  ///< "SSM"
  std::vector<std::string> command;  ///< argv; empty for a module that is connected to
  std::string connect;               ///< endpoint to connect to instead of a command
  std::string cwd;                   ///< empty = the hub's
  std::vector<std::string> env;      ///< "NAME=VALUE"
  Restart restart = Restart::kOnFailure;
  Dialect dialect = Dialect::kAuto;
  std::string framing = "lf";  ///< lf or mmi
  std::string encoding = "utf-8";
};

/// What an `agent_manager --config FILE` says. The schema is described in docs/configuration.md.
struct Config {
  std::vector<ModuleConfig> modules;
  std::vector<std::string> listen;
  std::vector<std::string> broadcast;  ///< names that hear what modules say to nobody in particular
  bool virtual_clock = false;
  std::string log;
  std::map<std::string, std::string> macros;  ///< name -> steps, as JSON text
  std::chrono::milliseconds start_limit{
      3000};  ///< for a module to answer to Clock, before it counts as original
};

/// Reads the JSON text. `origin` names it in errors: "am.json line 7: modules[0].restart: found
/// ...". Unknown keys and wrong types are errors. Macro files are read relative to `folder`.
vm::Result<Config> ParseConfig(std::string_view text, const std::string& origin,
                               const std::string& folder);

}  // namespace am
