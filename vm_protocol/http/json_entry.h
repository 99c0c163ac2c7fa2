#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vm {

/// An object of a configuration in JSON, read key by key; remembers the first thing that is wrong
/// with it, as `WHERE: "KEY" must be ...`.
/// Lifetime: the JSON outlives it.
class JsonEntry {
 public:
  JsonEntry(const nlohmann::json& json, std::string where);

  /// Without `otherwise` the key must be there.
  std::string Text(const char* key, const char* otherwise = nullptr);
  bool Flag(const char* key, bool otherwise);
  std::int64_t Number(const char* key, std::int64_t otherwise, std::int64_t least,
                      std::int64_t most);
  /// From 1 ms to ten minutes.
  std::chrono::milliseconds Limit(const char* key, std::chrono::milliseconds otherwise);
  /// Not empty.
  std::vector<std::string> Texts(const char* key);
  /// The value for the caller to look at; null where there is none.
  const nlohmann::json* Find(const char* key);
  void Bad(const std::string& key, const std::string& expected);
  /// kBadValue: what was wrong first, or a key nobody asked for.
  Result<void> Check();

 private:
  const nlohmann::json& json_;
  const std::string where_;
  std::vector<std::string> known_;
  std::string error_;
};

/// A path of a configuration: relative to its folder. "" stays empty.
std::string PathBeside(const std::string& folder, const std::string& path);

}  // namespace vm
