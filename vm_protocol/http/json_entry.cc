#include "vm_protocol/http/json_entry.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace vm {

using nlohmann::json;

JsonEntry::JsonEntry(const json& value, std::string where)
    : json_(value), where_(std::move(where)) {}

std::string JsonEntry::Text(const char* key, const char* otherwise) {
  const json* found = Find(key);
  if (found == nullptr && otherwise != nullptr) return otherwise;
  if (found == nullptr || !found->is_string()) return Bad(key, "a text"), "";
  return found->get<std::string>();
}

bool JsonEntry::Flag(const char* key, bool otherwise) {
  const json* found = Find(key);
  if (found == nullptr) return otherwise;
  if (!found->is_boolean()) return Bad(key, "true or false"), otherwise;
  return found->get<bool>();
}

std::int64_t JsonEntry::Number(const char* key, std::int64_t otherwise, std::int64_t least,
                               std::int64_t most) {
  const json* found = Find(key);
  if (found == nullptr) return otherwise;
  if (!found->is_number_integer() || *found < least || *found > most) {
    Bad(key, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    return otherwise;
  }
  return found->get<std::int64_t>();
}

std::chrono::milliseconds JsonEntry::Limit(const char* key, std::chrono::milliseconds otherwise) {
  return std::chrono::milliseconds(Number(key, otherwise.count(), 1, 600'000));
}

std::vector<std::string> JsonEntry::Texts(const char* key) {
  std::vector<std::string> texts;
  const json* found = Find(key);
  if (found == nullptr || !found->is_array() || found->empty()) return Bad(key, "a list"), texts;
  for (const json& one : *found) {
    if (!one.is_string()) return Bad(key, "a list of texts"), texts;
    texts.push_back(one.get<std::string>());
  }
  return texts;
}

const json* JsonEntry::Find(const char* key) {
  known_.emplace_back(key);
  const auto found = json_.find(key);
  return found == json_.end() ? nullptr : &*found;
}

void JsonEntry::Bad(const std::string& key, const std::string& expected) {
  if (error_.empty()) error_ = where_ + ": \"" + key + "\" must be " + expected;
}

Result<void> JsonEntry::Check() {
  for (const auto& [key, value] : json_.items()) {
    const bool known = std::ranges::find(known_, key) != known_.end();
    if (!known && error_.empty()) error_ = where_ + ": unknown key \"" + key + "\"";
  }
  if (error_.empty()) return {};
  return Fail(Errc::kBadValue, error_);
}

std::string PathBeside(const std::string& folder, const std::string& path) {
  return path.empty() || path.starts_with('/') ? path : folder + "/" + path;
}

}  // namespace vm
