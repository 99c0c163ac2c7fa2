#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "agent_manager/routing/hub.h"

namespace am {

/// Scripts of protocol lines, kept under a name (`def NAME << LINE`) or read from a file. `do`
/// sends the lines one after the other on behalf of the peer that asked for it, each to its
/// receiver (to @AM where a line has no `to`). Lifetime: the hub outlives it. Thread: none of its
/// own; one instance, one thread. Limits: kMaxScripts scripts of vm::kMaxMacroLines lines, together
/// kMaxBytes; one `do`, including the `do` lines in its scripts, sends at most vm::kMaxDoLines.
/// Errors: kLimit for each of these; a line that cannot be parsed has the parser's error and the
/// number of the line. After an error the kept scripts are as before.
class LineScripts {
 public:
  static constexpr std::size_t kMaxScripts = 1024;
  static constexpr std::size_t kMaxBytes = 4u << 20;
  using ReadFile = std::function<vm::Result<std::string>(const std::string& path)>;
  LineScripts(Hub& hub, ReadFile read_file);

  bool Has(const std::string& name) const { return scripts_.contains(name); }
  /// Adds lines to the script of that name; creates it if there is none.
  vm::Result<void> Append(const std::string& name, const std::string& line);
  /// Replaces the script of that name by the file's lines. Errors: also those of ReadFile.
  vm::Result<void> Load(const std::string& name, const std::string& path);
  /// Does nothing if there is no script of that name.
  void Delete(const std::string& name);
  /// Sends the lines of the script of that name or, if there is none, of the file at that path.
  /// Returns how many were sent; on an error none was.
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
