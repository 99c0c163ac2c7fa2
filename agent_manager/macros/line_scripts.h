#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "agent_manager/routing/hub.h"

namespace am {

/// Lines kept under a name (`def NAME << LINE`) or in a file, that `do` says one after the other,
/// as whoever does it, to whom each line says (without `to`: to @AM). Pure but for reading files.
/// Thread: one. Limits: kMaxScripts, kMaxBytes in all, vm::kMaxMacroLines lines of one,
/// vm::kMaxDoLines by one `do` with those within it.
class LineScripts {
 public:
  static constexpr std::size_t kMaxScripts = 1024;
  static constexpr std::size_t kMaxBytes = 4u << 20;
  using ReadFile = std::function<vm::Result<std::string>(const std::string& path)>;
  LineScripts(Hub& hub, ReadFile read_file);

  bool Has(const std::string& name) const { return scripts_.contains(name); }
  /// Errors: kSyntax for a line that is no message, kLimit.
  vm::Result<void> Append(const std::string& name, const std::string& line);
  vm::Result<void> Load(const std::string& name, const std::string& path);
  void Delete(const std::string& name);
  /// Says the lines of the script of that name, or of the file. Returns how many.
  vm::Result<std::size_t> Do(const std::string& name_or_path, const Origin& origin);

 private:
  struct Script {
    std::vector<vm::Message> lines;
    std::size_t bytes = 0;
  };
  static vm::Result<Script> Parse(std::string_view text, const std::string& where);
  vm::Result<void> Keep(const std::string& name, Script script);

  Hub& hub_;
  ReadFile read_file_;
  std::map<std::string, Script> scripts_;
  std::size_t bytes_ = 0;
};

}  // namespace am
