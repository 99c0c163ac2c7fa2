// Reads one rule from the configuration.

#include <algorithm>
#include <array>

#include "agent_manager/config/config_json.h"
#include "vm_protocol/core/message.h"

namespace am {
namespace {

std::vector<std::string> OneOrMore(const json& value, const std::string& key) {
  if (value.is_string()) return {Text(value, key)};
  return Texts(value, key);
}

std::vector<std::string> Names(const json& value, const std::string& key) {
  std::vector<std::string> names = OneOrMore(value, key);
  for (std::string& name : names) {
    if (name.starts_with('@')) name.erase(0, 1);
  }
  return names;
}

std::vector<std::string> Commands(const json& value, const std::string& key) {
  static constexpr std::array<std::string_view, 10> kCommands{"set", "inq", "prop", "save", "rest",
                                                              "del", "def", "do",   "rep",  "tell"};
  std::vector<std::string> commands = OneOrMore(value, key);
  for (const std::string& command : commands) {
    if (std::ranges::find(kCommands, command) == kCommands.end())
      Wrong(key, value, "commands: set inq prop save rest del def do rep tell");
  }
  return commands;
}

}  // namespace

Rule ReadRule(const json& object, const std::string& key, std::size_t number) {
  Rule rule;
  rule.name = "rule " + std::to_string(number);
  bool acts = false;
  using Read = std::function<void(const json&, const std::string&)>;
  const auto action = [&acts](Read read) -> Read {
    return [&acts, read = std::move(read)](const json& v, const std::string& k) {
      acts = true;
      read(v, k);
    };
  };
  ReadObject(
      object, key,
      {{"name", Into(rule.name, Text)},
       {"from", Into(rule.from, Names)},
       {"to", Into(rule.to, Names)},
       {"command", Into(rule.command, Commands)},
       {"slot", Into(rule.slot, OneOrMore)},
       {"value", Into(rule.value, OneOrMore)},
       {"role",
        [&](const json& v, const std::string& k) {
          const json list = v.is_array() ? v : json::array({v});
          ReadList(list, k, "a list of roles", [&](const json& role, const std::string& at) {
            rule.role.push_back(ReadRole(role, at));
          });
        }},
       {"copy_to", action(Into(rule.copy_to, Names))},
       {"rewrite", action([&](const json& v, const std::string& k) {
          ReadObject(
              v, k,
              {{"to", [&](const json& t, const std::string& at) { rule.new_to = Text(t, at); }},
               {"slot", [&](const json& t, const std::string& at) { rule.new_slot = Text(t, at); }},
               {"value",
                [&](const json& t, const std::string& at) { rule.new_value = Text(t, at); }}});
        })},
       {"drop", action(Into(rule.drop, Flag))},
       {"refuse", action(Into(rule.refuse, Text))},
       {"delay_ms", action([&](const json& v, const std::string& k) {
          rule.delay = Millis(v, k, 0, 3600000);
        })},
       {"per_second", action([&](const json& v, const std::string& k) {
          rule.per_s = static_cast<std::uint64_t>(Whole(v, k, 1, 1000000));
        })},
       {"note", action(Into(rule.note, Flag))},
       {"last", action(Into(rule.last, Flag))}});
  if (!acts)
    throw ConfigFault{key,
                      "expected what to do: copy_to, rewrite, drop, refuse, delay_ms, per_second, "
                      "note or last"};
  if (!rule.refuse.empty() && rule.refuse.size() > 1000) Wrong(key, object, "a shorter refusal");
  return rule;
}

}  // namespace am
