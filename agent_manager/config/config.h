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

/// Limits of one process, as in setrlimit(2); 0 = the same as the hub's.
struct ResourceLimits {
  unsigned long cpu_s = 0;      ///< processor time from its start
  unsigned long memory_mb = 0;  ///< address space, MiB
  unsigned long files = 0;      ///< open descriptors
  unsigned long file_mb = 0;    ///< size of each file it writes, MiB
  int nice = 0;                 ///< added to the hub's niceness
  bool operator==(const ResourceLimits&) const = default;
};

/// The hub kills a module that does not answer `inq Run` within `within`, `misses` times in a row;
/// the restart policy says whether it is started again. Real clock only.
struct HealthCheck {
  std::chrono::milliseconds every{0};  ///< 0 = no checks
  std::chrono::milliseconds within{2000};
  unsigned misses = 3;
  bool operator==(const HealthCheck&) const = default;
};

/// An endpoint on which the hub accepts clients and modules.
struct ListenConfig {
  std::string at;  ///< endpoint
  /// Role of the peers accepted here; none: client on a Unix socket, guest on others.
  std::optional<Role> role;
  vm::Credentials credentials;
  bool operator==(const ListenConfig&) const = default;
};

/// The hub's page. Served to this machine only; a tunnel can reach it from others.
struct WebConfig {
  std::string at;          ///< tcp:127.0.0.1:PORT; empty: no page
  std::string token_file;  ///< empty: a new token at each start, printed on stderr
  Role role = Role::kGuest;
  bool operator==(const WebConfig&) const = default;
};

/// An MQTT 5 broker that connects this hub's modules with those of other agents.
struct MqttConfig {
  std::string broker;            ///< tcp:HOST:PORT or tls:HOST:PORT; empty: none
  std::string agent;             ///< our name there
  std::string root = "galatea";  ///< topic level above the agents' names
  std::string user;
  std::string password_file;
  vm::Credentials credentials;       ///< for tls: certificate, key, authority
  std::vector<std::string> modules;  ///< patterns of the modules visible there; empty = all
  Role role = Role::kGuest;          ///< of messages from there
  std::chrono::seconds keep_alive{15};
  bool operator==(const MqttConfig&) const = default;
};

struct ModuleConfig {
  std::string name;                  ///< "SSM"
  std::vector<std::string> command;  ///< argv; empty if `connect` is set
  std::string connect;               ///< endpoint to connect to instead of a command
  vm::Credentials credentials;       ///< for connect
  std::string cwd;                   ///< empty = the hub's
  std::vector<std::string> env;      ///< "NAME=VALUE"
  RestartPolicy restart;
  std::vector<std::string> after;  ///< modules that must be ready before this one is started
  std::string ready_slot;          ///< ready when this slot has ready_value; empty = on any message
  std::string ready_value;
  std::chrono::milliseconds ready_within{60000};  ///< killed if it is not ready by then
  HealthCheck health;
  ResourceLimits limits;
  /// After `set Run = EXIT`, before SIGTERM; none: 4 s.
  std::optional<std::chrono::milliseconds> stop_within;
  Dialect dialect = Dialect::kAuto;
  std::string framing = "lf";  ///< lf or mmi
  std::string encoding = "utf-8";

  bool operator==(const ModuleConfig&) const = default;
};

/// The contents of a configuration file. The schema is described in docs/configuration.md.
struct Config {
  std::vector<ModuleConfig> modules;
  std::vector<ListenConfig> listen;
  Limits limits;
  RightsTable rights = RightsTable::Default();
  std::vector<Rule> rules;             ///< applied in this order
  std::vector<std::string> broadcast;  ///< receivers of messages without a receiver
  bool virtual_clock = false;
  /// Real clock: how long the hub polls for work before it blocks, since waking up takes longer
  /// than handling a message. 0: it blocks at once.
  std::chrono::microseconds spin{0};
  LogConfig log;
  WebConfig web;
  MqttConfig mqtt;
  std::vector<std::string> notes;             ///< for people: what was ignored and why
  std::map<std::string, std::string> macros;  ///< name -> steps, as JSON text
  std::chrono::milliseconds start_limit{
      3000};  ///< for a module to answer to Clock, else it is taken for one of the original
};

/// Reads the JSON text. `origin` names it in errors: "am.json line 7: modules[0].restart: found
/// ...". Unknown keys and wrong types are errors. Macro files are read relative to `folder`.
vm::Result<Config> ParseConfig(std::string_view text, const std::string& origin,
                               const std::string& folder);

}  // namespace am
