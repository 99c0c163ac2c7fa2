// Reads one module from the configuration.

#include "agent_manager/config/config_json.h"
#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/message.h"

namespace am {
namespace {

RestartPolicy ReadRestart(const json& value, const std::string& key) {
  const auto when = [](const json& v, const std::string& k) {
    return OneOf<Restart>(v, k,
                          {{"never", Restart::kNever},
                           {"on-failure", Restart::kOnFailure},
                           {"always", Restart::kAlways}});
  };
  RestartPolicy policy;
  if (!value.is_object()) {
    policy.when = when(value, key);
    return policy;
  }
  const auto into = [](RestartPolicy::Millis& target, long least) {
    return [&target, least](const json& v, const std::string& k) {
      target = Millis(v, k, least, 86400000);
    };
  };
  ReadObject(value, key,
             {{"when", Into(policy.when, when)},
              {"first_ms", into(policy.first, 0)},
              {"longest_ms", into(policy.longest, 0)},
              {"within_ms", into(policy.within, 1)},
              {"tries", [&](const json& v, const std::string& k) {
                 policy.tries = static_cast<unsigned>(Whole(v, k, 0, 1000000));
               }}});
  return policy;
}

ResourceLimits ReadResourceLimits(const json& value, const std::string& key) {
  ResourceLimits limits;
  const auto into = [](unsigned long& target) {
    return [&target](const json& v, const std::string& k) {
      target = static_cast<unsigned long>(Whole(v, k, 1, 1l << 40));
    };
  };
  ReadObject(value, key,
             {{"cpu_s", into(limits.cpu_s)},
              {"memory_mb", into(limits.memory_mb)},
              {"files", into(limits.files)},
              {"file_mb", into(limits.file_mb)},
              {"nice", [&](const json& v, const std::string& k) {
                 limits.nice = static_cast<int>(Whole(v, k, -20, 19));
               }}});
  return limits;
}

HealthCheck ReadHealth(const json& value, const std::string& key) {
  HealthCheck health;
  const auto into = [](std::chrono::milliseconds& target) {
    return [&target](const json& v, const std::string& k) { target = Millis(v, k, 10, 3600000); };
  };
  ReadObject(value, key,
             {{"every_ms", into(health.every)},
              {"within_ms", into(health.within)},
              {"misses", [&](const json& v, const std::string& k) {
                 health.misses = static_cast<unsigned>(Whole(v, k, 1, 1000));
               }}});
  if (health.every.count() == 0)
    throw ConfigFault{key + ".every_ms", "missing, expected how often to ask"};
  return health;
}

/// A string is a command line for the shell, a list is argv.
std::vector<std::string> ReadCommand(const json& value, const std::string& key) {
  auto command = value.is_string() ? std::vector<std::string>{"/bin/sh", "-c", Text(value, key)}
                                   : Texts(value, key);
  if (command.empty()) Wrong(key, value, "a program and its arguments");
  return command;
}

std::vector<std::string> ReadEnvironment(const json& value, const std::string& key) {
  if (!value.is_object()) Wrong(key, value, "an object of strings");
  std::vector<std::string> entries;
  for (const auto& [name, text] : value.items())
    entries.push_back(name + "=" + Text(text, key + "." + name));
  return entries;
}

std::string ReadName(const json& value, const std::string& key) {
  std::string name = Text(value, key);
  if (!vm::IsModuleName(name)) Wrong(key, value, "letters, digits, '_' or '-'");
  if (IsReservedName(name)) throw ConfigFault{key, "found '" + name + "', a name of the hub's own"};
  return name;
}

void ReadReady(const json& value, const std::string& key, ModuleConfig& module) {
  const auto report = vm::ParseMessage("rep " + Text(value, key));
  if (!report || report->relation != vm::Relation::kAssign)
    Wrong(key, value, "SLOT = VALUE, such as Run = LIVE");
  module.ready_slot = report->slot;
  module.ready_value = report->value;
}

/// A reader of a string that must be one of `words`.
auto WordOf(std::vector<std::string> words) {
  return [words = std::move(words)](const json& v, const std::string& k) {
    std::vector<std::pair<std::string, std::string>> choices;
    for (const std::string& word : words) choices.emplace_back(word, word);
    return OneOf<std::string>(v, k, choices);
  };
}

}  // namespace

ModuleConfig ReadModule(const json& object, const std::string& key) {
  ModuleConfig module;
  const auto millis = [](long least, long most) {
    return [least, most](const json& v, const std::string& k) { return Millis(v, k, least, most); };
  };
  const auto dialect = [](const json& v, const std::string& k) {
    return OneOf<Dialect>(
        v, k,
        {{"auto", Dialect::kAuto}, {"modern", Dialect::kModern}, {"original", Dialect::kOriginal}});
  };
  Readers readers{{"name", Into(module.name, ReadName)},
                  {"command", Into(module.command, ReadCommand)},
                  {"connect", Into(module.connect, Text)},
                  {"cwd", Into(module.cwd, Text)},
                  {"env", Into(module.env, ReadEnvironment)},
                  {"restart", Into(module.restart, ReadRestart)},
                  {"after", Into(module.after, Texts)},
                  {"ready", [&](const json& v, const std::string& k) { ReadReady(v, k, module); }},
                  {"ready_within_ms", Into(module.ready_within, millis(100, 3600000))},
                  {"health", Into(module.health, ReadHealth)},
                  {"limits", Into(module.limits, ReadResourceLimits)},
                  {"stop_within_ms", Into(module.stop_within, millis(0, 600000))},
                  {"dialect", Into(module.dialect, dialect)},
                  {"framing", Into(module.framing, WordOf({"lf", "mmi"}))},
                  {"encoding", Into(module.encoding, WordOf({"utf-8", "euc-jp", "shift_jis"}))}};
  AddCredentialReaders(readers, module.credentials);
  ReadObject(object, key, readers);
  if (module.name.empty()) throw ConfigFault{key + ".name", "missing, expected the module's name"};
  if (module.command.empty() == module.connect.empty())
    throw ConfigFault{key, "expected either command or connect"};
  return module;
}

}  // namespace am
