#include <algorithm>
#include <filesystem>
#include <set>

#include "agent_manager/config/config.h"
#include "agent_manager/config/config_json.h"

namespace am {

using vm::Errc;
using vm::Fail;
using vm::Result;

namespace {

/// Checks that `after` names existing modules and has no cycle.
void CheckOrder(const std::vector<ModuleConfig>& modules, const std::string& key) {
  std::set<std::string> placed;
  for (bool more = true; more;) {
    more = false;
    for (const ModuleConfig& module : modules) {
      if (placed.contains(module.name) ||
          !std::ranges::all_of(module.after,
                               [&](const std::string& name) { return placed.contains(name); }))
        continue;
      placed.insert(module.name);
      more = true;
    }
  }
  for (std::size_t i = 0; i < modules.size(); ++i) {
    if (placed.contains(modules[i].name)) continue;
    const std::string at = key + "[" + std::to_string(i) + "].after";
    for (const std::string& name : modules[i].after) {
      if (std::ranges::find(modules, name, &ModuleConfig::name) == modules.end())
        throw ConfigFault{at, "there is no module " + name};
    }
    throw ConfigFault{at, "these modules wait for each other in a circle"};
  }
}

std::vector<ModuleConfig> ReadModules(const json& value, const std::string& key) {
  std::vector<ModuleConfig> modules;
  std::set<std::string> names;
  ReadList(value, key, "a list of modules", [&](const json& module, const std::string& at) {
    modules.push_back(ReadModule(module, at));
    if (!names.insert(modules.back().name).second)
      throw ConfigFault{at + ".name", "the name is taken twice"};
  });
  CheckOrder(modules, key);
  return modules;
}

std::vector<ListenConfig> ReadListeners(const json& value, const std::string& key) {
  std::vector<ListenConfig> listeners;
  ReadList(value, key, "a list of endpoints", [&](const json& item, const std::string& at) {
    listeners.push_back(ReadListen(item, at));
  });
  return listeners;
}

Limits ReadLimits(const json& value, const std::string& key) {
  Limits limits;
  Readers readers;
  for (const LimitName& limit : LimitNames()) {
    readers[limit.name] = [&](const json& n, const std::string& at) {
      limits.*limit.member = static_cast<std::uint64_t>(
          Whole(n, at, static_cast<long>(limit.least), static_cast<long>(limit.most)));
    };
  }
  ReadObject(value, key, readers);
  return limits;
}

std::vector<Rule> ReadRules(const json& value, const std::string& key) {
  std::vector<Rule> rules;
  ReadList(value, key, "a list of rules", [&](const json& rule, const std::string& at) {
    rules.push_back(ReadRule(rule, at, rules.size() + 1));
    if (rules.size() > Rules::kMaxRules)
      throw ConfigFault{at, "more than " + std::to_string(Rules::kMaxRules) + " rules"};
  });
  return rules;
}

/// Reads the text of each macro: its steps, or those of a file in `folder`.
std::map<std::string, std::string> ReadMacros(const json& value, const std::string& key,
                                              const std::filesystem::path& folder) {
  if (!value.is_object()) Wrong(key, value, "an object: name to steps, or to a file's name");
  std::map<std::string, std::string> macros;
  for (const auto& [name, steps] : value.items())
    macros[name] = steps.is_string() ? ReadTextFile((folder / steps.get<std::string>()).string(),
                                                    key + "." + name)
                                     : steps.dump();
  return macros;
}

Config ReadConfig(const json& root, const std::string& folder) {
  Config config;
  const auto clock = [](const json& v, const std::string& k) {
    return OneOf<bool>(v, k, {{"real", false}, {"virtual", true}});
  };
  const auto spin = [](const json& v, const std::string& k) {
    return std::chrono::microseconds(Whole(v, k, 0, 10000));
  };
  const auto start_limit = [](const json& v, const std::string& k) {
    return Millis(v, k, 100, 600000);
  };
  const auto macros = [&folder](const json& v, const std::string& k) {
    return ReadMacros(v, k, folder);
  };
  ReadObject(root, "",
             {{"modules", Into(config.modules, ReadModules)},
              {"listen", Into(config.listen, ReadListeners)},
              {"limits", Into(config.limits, ReadLimits)},
              {"rights", Into(config.rights, ReadRights)},
              {"broadcast", Into(config.broadcast, Texts)},
              {"clock", Into(config.virtual_clock, clock)},
              {"log", Into(config.log, ReadLogConfig)},
              {"web", Into(config.web, ReadWeb)},
              {"mqtt", Into(config.mqtt, ReadMqtt)},
              {"rules", Into(config.rules, ReadRules)},
              {"spin_us", Into(config.spin, spin)},
              {"start_limit_ms", Into(config.start_limit, start_limit)},
              {"macros", Into(config.macros, macros)}});
  if (config.virtual_clock && !config.mqtt.broker.empty())
    throw ConfigFault{"mqtt", "other agents do not follow a virtual clock, expected clock: real"};
  // On the virtual clock a face may have a film to finish, however busy the machine is.
  for (ModuleConfig& module : config.modules)
    if (config.virtual_clock && !module.stop_within) module.stop_within = std::chrono::seconds(60);
  return config;
}

}  // namespace

Result<Config> ParseConfig(std::string_view text, const std::string& origin,
                           const std::string& folder) {
  json root;
  try {
    root = ParseJson(text, origin);
  } catch (const ConfigFault& fault) {
    return Fail(
        fault.text.find(": not JSON: ") != std::string::npos ? Errc::kSyntax : Errc::kBadValue,
        fault.text);
  }
  try {
    return ReadConfig(root, folder);
  } catch (const ConfigFault& fault) {
    return Fail(Errc::kBadValue, origin + " line " + std::to_string(LineOfKey(text, fault.key)) +
                                     ": " + fault.key + ": " + fault.text);
  }
}

}  // namespace am
