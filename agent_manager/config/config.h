#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agent_manager/access/rights.h"
#include "agent_manager/config/restart_policy.h"
#include "agent_manager/log/log_config.h"
#include "agent_manager/routing/dialect.h"
#include "agent_manager/routing/limits.h"
#include "agent_manager/routing/rules.h"
#include "vm_protocol/core/result.h"
#include "vm_protocol/runtime/credentials.h"

namespace am {

/// What one process may use; 0 = as the hub itself. setrlimit(2) has the exact meanings.
struct ResourceLimits {
  unsigned long cpu_s = 0;      ///< processor time of one life of the process
  unsigned long memory_mb = 0;  ///< address space, MiB
  unsigned long files = 0;      ///< open descriptors
  unsigned long file_mb = 0;    ///< size of a file it writes, MiB
  int nice = 0;                 ///< added to the hub's own
  bool operator==(const ResourceLimits&) const = default;
};

/// A module that leaves `inq Run` unanswered for `within`, `misses` times in a row, is ended by
/// force; the restart policy has the rest. Real clock only.
struct HealthCheck {
  std::chrono::milliseconds every{0};  ///< 0 = no checks
  std::chrono::milliseconds within{2000};
  unsigned misses = 3;
  bool operator==(const HealthCheck&) const = default;
};

/// A place where clients and modules come in.
struct ListenConfig {
  std::string at;  ///< endpoint
  /// Of those who come here; none: a client over a Unix socket, else a guest.
  std::optional<Role> role;
  vm::Credentials credentials;
  bool operator==(const ListenConfig&) const = default;
};

/// The hub's page. Only for this machine: others come by a tunnel.
struct WebConfig {
  std::string at;          ///< tcp:127.0.0.1:PORT; empty: no page
  std::string token_file;  ///< empty: a new token at each start, told on stderr
  Role role = Role::kGuest;
  bool operator==(const WebConfig&) const = default;
};

/// An MQTT 5 broker by which other agents reach our modules and we theirs.
struct MqttConfig {
  std::string broker;            ///< tcp:HOST:PORT or tls:HOST:PORT; empty: none
  std::string agent;             ///< what we are called there
  std::string root = "galatea";  ///< the level above the agents
  std::string user;
  std::string password_file;
  vm::Credentials credentials;       ///< for tls: certificate, key, authority
  std::vector<std::string> modules;  ///< patterns: who is shown and may be spoken to; empty = all
  Role role = Role::kGuest;          ///< with which what comes from there is said
  std::chrono::seconds keep_alive{15};
  bool operator==(const MqttConfig&) const = default;
};

struct ModuleConfig {
  std::string name;                  ///< "SSM"
  std::vector<std::string> command;  ///< argv; empty for a module that is connected to
  std::string connect;               ///< endpoint to connect to instead of a command
  vm::Credentials credentials;       ///< for connect
  std::string cwd;                   ///< empty = the hub's
  std::vector<std::string> env;      ///< "NAME=VALUE"
  RestartPolicy restart;
  std::vector<std::string> after;  ///< modules that must be ready before this one is started
  std::string ready_slot;          ///< ready when this slot has ready_value; empty = once it speaks
  std::string ready_value;
  std::chrono::milliseconds ready_within{60000};  ///< else it is ended by force
  HealthCheck health;
  ResourceLimits limits;
  std::chrono::milliseconds stop_within{4000};  ///< after `set Run = EXIT`, before SIGTERM
  Dialect dialect = Dialect::kAuto;
  std::string framing = "lf";  ///< lf or mmi
  std::string encoding = "utf-8";

  bool operator==(const ModuleConfig&) const = default;
};

/// What an `agent_manager --config FILE` says. The schema is described in docs/configuration.md.
struct Config {
  std::vector<ModuleConfig> modules;
  std::vector<ListenConfig> listen;
  Limits limits;
  RightsTable rights = RightsTable::Default();
  std::vector<Rule> rules;             ///< in the order in which they are applied
  std::vector<std::string> broadcast;  ///< names that hear what modules say to nobody in particular
  bool virtual_clock = false;
  /// Real clock: how long the hub looks for work before it lets the system put it to sleep, since
  /// being woken takes longer than a message. 0: it sleeps at once.
  std::chrono::microseconds spin{0};
  LogConfig log;
  WebConfig web;
  MqttConfig mqtt;
  std::vector<std::string> notes;             ///< for people: what was passed over and why
  std::map<std::string, std::string> macros;  ///< name -> steps, as JSON text
  std::chrono::milliseconds start_limit{
      3000};  ///< for a module to answer to Clock, before it counts as original
};

/// Reads the JSON text. `origin` names it in errors: "am.json line 7: modules[0].restart: found
/// ...". Unknown keys and wrong types are errors. Macro files are read relative to `folder`.
vm::Result<Config> ParseConfig(std::string_view text, const std::string& origin,
                               const std::string& folder);

}  // namespace am
