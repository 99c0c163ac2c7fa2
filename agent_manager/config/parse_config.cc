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

/// Every module comes after modules that exist, and nowhere in a circle.
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
    Config config;
    ReadObject(
        root, "",
        {{"modules",
          [&](const json& v, const std::string& k) {
            std::set<std::string> names;
            ReadList(v, k, "a list of modules", [&](const json& module, const std::string& key) {
              config.modules.push_back(ReadModule(module, key));
              if (!names.insert(config.modules.back().name).second)
                throw ConfigFault{key + ".name", "the name is taken twice"};
            });
            CheckOrder(config.modules, k);
          }},
         {"listen",
          [&](const json& v, const std::string& k) {
            ReadList(v, k, "a list of endpoints", [&](const json& item, const std::string& key) {
              config.listen.push_back(ReadListen(item, key));
            });
          }},
         {"limits",
          [&](const json& v, const std::string& k) {
            Readers readers;
            for (const LimitName& limit : LimitNames()) {
              readers[limit.name] = [&config, &limit](const json& n, const std::string& at) {
                config.limits.*limit.member = static_cast<std::uint64_t>(
                    Whole(n, at, static_cast<long>(limit.least), static_cast<long>(limit.most)));
              };
            }
            ReadObject(v, k, readers);
          }},
         {"rights", [&](const json& v, const std::string& k) { config.rights = ReadRights(v, k); }},
         {"broadcast",
          [&](const json& v, const std::string& k) { config.broadcast = Texts(v, k); }},
         {"clock",
          [&](const json& v, const std::string& k) {
            config.virtual_clock = OneOf<bool>(v, k, {{"real", false}, {"virtual", true}});
          }},
         {"log", [&](const json& v, const std::string& k) { config.log = ReadLogConfig(v, k); }},
         {"web", [&](const json& v, const std::string& k) { config.web = ReadWeb(v, k); }},
         {"mqtt", [&](const json& v, const std::string& k) { config.mqtt = ReadMqtt(v, k); }},
         {"rules",
          [&](const json& v, const std::string& k) {
            ReadList(v, k, "a list of rules", [&](const json& rule, const std::string& key) {
              config.rules.push_back(ReadRule(rule, key, config.rules.size() + 1));
              if (config.rules.size() > Rules::kMaxRules)
                throw ConfigFault{key, "more than " + std::to_string(Rules::kMaxRules) + " rules"};
            });
          }},
         {"spin_us",
          [&](const json& v, const std::string& k) {
            config.spin = std::chrono::microseconds(Whole(v, k, 0, 10000));
          }},
         {"start_limit_ms",
          [&](const json& v, const std::string& k) {
            config.start_limit = Millis(v, k, 100, 600000);
          }},
         {"macros", [&](const json& v, const std::string& k) {
            if (!v.is_object()) Wrong(k, v, "an object: name to steps, or to a file's name");
            for (const auto& [name, steps] : v.items()) {
              const std::string key = k + "." + name;
              config.macros[name] =
                  steps.is_string()
                      ? ReadTextFile(
                            (std::filesystem::path(folder) / steps.get<std::string>()).string(),
                            key)
                      : steps.dump();
            }
          }}});
    if (config.virtual_clock && !config.mqtt.broker.empty())
      throw ConfigFault{"mqtt", "other agents do not follow a virtual clock, expected clock: real"};
    return config;
  } catch (const ConfigFault& fault) {
    return Fail(Errc::kBadValue, origin + " line " + std::to_string(LineOfKey(text, fault.key)) +
                                     ": " + fault.key + ": " + fault.text);
  }
}

}  // namespace am
