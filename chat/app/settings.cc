#include "chat/app/settings.h"

#include <functional>
#include <map>
#include <nlohmann/json.hpp>

namespace chat {
namespace {

using nlohmann::json;
using vm::Errc;
using vm::Fail;

using Reader = std::function<vm::Result<void>(const json&)>;

vm::Result<void> Wrong(const char* expected) {
  return Fail(Errc::kBadValue, std::string("expected ") + expected);
}

Reader Text(std::string& target) {
  return [&target](const json& value) -> vm::Result<void> {
    if (!value.is_string()) return Wrong("a string");
    target = value.get<std::string>();
    return {};
  };
}

Reader File(std::string& target, const std::string& folder) {
  return [&target, folder](const json& value) -> vm::Result<void> {
    if (!value.is_string() || value.get<std::string>().empty()) return Wrong("a file's name");
    const auto name = value.get<std::string>();
    target = name.starts_with('/') || folder.empty() ? name : folder + "/" + name;
    return {};
  };
}

Reader Texts(std::vector<std::string>& target, const std::string& folder = "") {
  return [&target, folder](const json& value) -> vm::Result<void> {
    if (!value.is_array()) return Wrong("a list of strings");
    target.clear();
    for (const json& one : value) {
      std::string text;
      const auto read = folder.empty() ? Text(text)(one) : File(text, folder)(one);
      if (!read) return read;
      target.push_back(std::move(text));
    }
    return {};
  };
}

vm::Result<void> ReadLimits(const json& value, Settings& settings) {
  static const std::map<std::string, std::string> slots{
      {"tokens", "Model.tokens"},         {"seconds", "Model.seconds"},
      {"stall", "Model.stall"},           {"bytes", "Model.bytes"},
      {"history_turns", "History.turns"}, {"tool_rounds", "Tools.rounds"}};
  if (!value.is_object()) return Wrong("an object of numbers");
  for (const auto& [name, number] : value.items()) {
    const auto slot = slots.find(name);
    if (slot == slots.end() || !number.is_number_integer())
      return Fail(Errc::kBadValue, name +
                                       ": expected a number for tokens, seconds, stall, bytes, "
                                       "history_turns or tool_rounds");
    settings.limits.emplace_back(slot->second, number.get<long>());
  }
  return {};
}

}  // namespace

vm::Result<void> ReadSettings(const std::string& file, std::string_view text,
                              const std::string& folder, Settings& settings) {
  const json root = json::parse(text, nullptr, false, true);
  if (!root.is_object()) return Fail(Errc::kSyntax, file + ": expected a JSON object");
  const std::map<std::string, Reader> readers{
      {"url", Text(settings.url)},
      {"model", Text(settings.model)},
      {"key_file", File(settings.key_file, folder)},
      {"prompt_file", File(settings.prompt_file, folder)},
      {"persona", Text(settings.persona)},
      {"agent", Text(settings.agent)},
      {"tags_file", File(settings.tags_file, folder)},
      {"apologies_file", File(settings.apologies_file, folder)},
      {"rules_files", Texts(settings.rules_files, folder.empty() ? "." : folder)},
      {"allow_set", Texts(settings.allow_set)},
      {"listen",
       [&settings](const json& value) -> vm::Result<void> {
         if (!value.is_boolean()) return Wrong("true or false");
         settings.listen = value.get<bool>();
         return {};
       }},
      {"body",
       [&settings](const json& value) -> vm::Result<void> {
         if (!value.is_object()) return Wrong("an object");
         settings.body = value.dump();
         return {};
       }},
      {"limits", [&settings](const json& value) { return ReadLimits(value, settings); }}};
  for (const auto& [key, value] : root.items()) {
    const auto reader = readers.find(key);
    if (reader == readers.end())
      return Fail(Errc::kBadValue, file + ": there is no key '" + key + "'");
    if (const auto read = reader->second(value); !read)
      return Fail(read.error().code, file + ": " + key + ": " + read.error().text);
  }
  return {};
}

Settings Over(Settings base, const Settings& given) {
  for (std::string Settings::*const text :
       {&Settings::url, &Settings::model, &Settings::key_file, &Settings::prompt_file,
        &Settings::persona, &Settings::agent, &Settings::tags_file, &Settings::apologies_file}) {
    if (!(given.*text).empty()) base.*text = given.*text;
  }
  for (std::vector<std::string> Settings::*const list :
       {&Settings::rules_files, &Settings::allow_set}) {
    if (!(given.*list).empty()) base.*list = given.*list;
  }
  base.listen = base.listen && given.listen;
  return base;
}

}  // namespace chat
