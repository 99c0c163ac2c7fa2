#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vm_protocol/core/result.h"

namespace chat {

/// What the command line and the configuration say. Names of files are as given; those in a
/// configuration are relative to it.
struct Settings {
  std::string url, model, key_file;
  std::string prompt_file, persona, agent;
  std::string tags_file, apologies_file;
  std::vector<std::string> rules_files;
  std::vector<std::string> allow_set;
  std::string body = "{}";                           ///< JSON: further members of each request
  std::vector<std::pair<std::string, long>> limits;  ///< slot, value
  bool listen = true;
};

/// Reads a configuration (docs/chat.md) over what `settings` has. `folder` is where its files are.
/// Errors: kSyntax, kBadValue with the file's name and the key.
vm::Result<void> ReadSettings(const std::string& file, std::string_view text,
                              const std::string& folder, Settings& settings);

/// `base` with everything that `given` says instead.
Settings Over(Settings base, const Settings& given);

}  // namespace chat
