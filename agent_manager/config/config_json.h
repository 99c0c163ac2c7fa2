#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agent_manager/config/config.h"

/// Reads a configuration's JSON member by member. Every function throws ConfigFault, with the key
/// of the member, for a value it does not accept. Only for files that read configurations or
/// macros.
namespace am {

using nlohmann::json;

/// A fault at a key; turned into a vm::Error, with the line, by ParseConfig.
struct ConfigFault {
  std::string key;
  std::string text;
};

[[noreturn]] void Wrong(const std::string& key, const json& value, const std::string& expected);
std::string Text(const json& value, const std::string& key);
std::vector<std::string> Texts(const json& value, const std::string& key);
/// A whole number from `least` to `most`.
long Whole(const json& value, const std::string& key, long least, long most);
bool Flag(const json& value, const std::string& key);
std::chrono::milliseconds Millis(const json& value, const std::string& key, long least, long most);

/// A reader that stores the result of `read` in `target`.
template <typename T, typename Read>
auto Into(T& target, Read read) {
  return [&target, read](const json& v, const std::string& k) { target = read(v, k); };
}

template <typename T>
T OneOf(const json& value, const std::string& key,
        const std::vector<std::pair<std::string, T>>& words) {
  std::string expected;
  for (const auto& [word, meaning] : words) {
    if (value.is_string() && value.get<std::string>() == word) return meaning;
    expected += (expected.empty() ? "" : ", ") + word;
  }
  Wrong(key, value, "one of " + expected);
}

/// Calls the reader of each member; a member without a reader is a fault.
using Readers = std::map<std::string, std::function<void(const json&, const std::string& key)>>;
void ReadObject(const json& object, const std::string& key, const Readers& readers);
/// Calls `read` for every element of a list.
void ReadList(const json& list, const std::string& key, const std::string& expected,
              const std::function<void(const json&, const std::string& key)>& read);
std::string ReadTextFile(const std::string& path, const std::string& key);

Role ReadRole(const json& value, const std::string& key);
/// "rights": the default table, in which the given members replace those of each role.
RightsTable ReadRights(const json& value, const std::string& key);
/// Readers of token_file, certificate, key and authority; files relative to the hub's working
/// folder.
void AddCredentialReaders(Readers& readers, vm::Credentials& credentials);
ListenConfig ReadListen(const json& value, const std::string& key);
WebConfig ReadWeb(const json& value, const std::string& key);
MqttConfig ReadMqtt(const json& value, const std::string& key);
LogConfig ReadLogConfig(const json& value, const std::string& key);
ModuleConfig ReadModule(const json& object, const std::string& key);
/// A rule without a name is called "rule NUMBER".
Rule ReadRule(const json& object, const std::string& key, std::size_t number);

/// Parses JSON with comments and unique keys. Throws ConfigFault with the line in its text.
json ParseJson(std::string_view text, const std::string& origin);
/// Returns the line of a key such as "modules[1].env.A", or of its deepest part in the text.
std::size_t LineOfKey(std::string_view text, std::string_view key);

}  // namespace am
