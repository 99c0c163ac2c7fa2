// The members of one module in the configuration.

#include "agent_manager/config/config_json.h"
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
             {{"when", [&](const json& v, const std::string& k) { policy.when = when(v, k); }},
              {"first_ms", into(policy.first, 0)},
              {"longest_ms", into(policy.longest, 0)},
              {"within_ms", into(policy.within, 1)},
              {"tries", [&](const json& v, const std::string& k) {
                 policy.tries = static_cast<unsigned>(Whole(v, k, 0, 1000000));
               }}});
  return policy;
}

ResourceLimits ReadLimits(const json& value, const std::string& key) {
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

}  // namespace

ModuleConfig ReadModule(const json& object, const std::string& key) {
  ModuleConfig module;
  Readers readers{
      {"name",
       [&](const json& v, const std::string& k) {
         module.name = Text(v, k);
         if (!vm::IsModuleName(module.name)) Wrong(k, v, "letters, digits, '_' or '-'");
       }},
      {"command",
       [&](const json& v, const std::string& k) {
         module.command =
             v.is_string() ? std::vector<std::string>{"/bin/sh", "-c", Text(v, k)} : Texts(v, k);
         if (module.command.empty()) Wrong(k, v, "a program and its arguments");
       }},
      {"connect", [&](const json& v, const std::string& k) { module.connect = Text(v, k); }},
      {"cwd", [&](const json& v, const std::string& k) { module.cwd = Text(v, k); }},
      {"env",
       [&](const json& v, const std::string& k) {
         if (!v.is_object()) Wrong(k, v, "an object of strings");
         for (const auto& [name, value] : v.items())
           module.env.push_back(name + "=" + Text(value, k + "." + name));
       }},
      {"restart", [&](const json& v, const std::string& k) { module.restart = ReadRestart(v, k); }},
      {"after", [&](const json& v, const std::string& k) { module.after = Texts(v, k); }},
      {"ready",
       [&](const json& v, const std::string& k) {
         const auto report = vm::ParseMessage("rep " + Text(v, k));
         if (!report || report->relation != vm::Relation::kAssign)
           Wrong(k, v, "SLOT = VALUE, such as Run = LIVE");
         module.ready_slot = report->slot;
         module.ready_value = report->value;
       }},
      {"ready_within_ms",
       [&](const json& v, const std::string& k) {
         module.ready_within = Millis(v, k, 100, 3600000);
       }},
      {"health",
       [&](const json& v, const std::string& k) {
         ReadObject(v, k,
                    {{"every_ms",
                      [&](const json& e, const std::string& at) {
                        module.health.every = Millis(e, at, 10, 3600000);
                      }},
                     {"within_ms",
                      [&](const json& e, const std::string& at) {
                        module.health.within = Millis(e, at, 10, 3600000);
                      }},
                     {"misses", [&](const json& e, const std::string& at) {
                        module.health.misses = static_cast<unsigned>(Whole(e, at, 1, 1000));
                      }}});
         if (module.health.every.count() == 0)
           throw ConfigFault{k + ".every_ms", "missing, expected how often to ask"};
       }},
      {"limits", [&](const json& v, const std::string& k) { module.limits = ReadLimits(v, k); }},
      {"stop_within_ms",
       [&](const json& v, const std::string& k) { module.stop_within = Millis(v, k, 0, 600000); }},
      {"dialect",
       [&](const json& v, const std::string& k) {
         module.dialect = OneOf<Dialect>(v, k,
                                         {{"auto", Dialect::kAuto},
                                          {"modern", Dialect::kModern},
                                          {"original", Dialect::kOriginal}});
       }},
      {"framing",
       [&](const json& v, const std::string& k) {
         module.framing = OneOf<std::string>(v, k, {{"lf", "lf"}, {"mmi", "mmi"}});
       }},
      {"encoding", [&](const json& v, const std::string& k) {
         module.encoding = OneOf<std::string>(
             v, k, {{"utf-8", "utf-8"}, {"euc-jp", "euc-jp"}, {"shift_jis", "shift_jis"}});
       }}};
  AddCredentialReaders(readers, module.credentials);
  ReadObject(object, key, readers);
  if (module.name.empty()) throw ConfigFault{key + ".name", "missing, expected the module's name"};
  for (const char* const own : {"AM", "AM-MCL", "FS-MCL", "CONSOLE", "MQTT"}) {
    if (module.name == own)
      throw ConfigFault{key + ".name", "found '" + module.name + "', a name of the hub's own"};
  }
  if (module.command.empty() == module.connect.empty())
    throw ConfigFault{key, "expected either command or connect"};
  return module;
}

}  // namespace am
