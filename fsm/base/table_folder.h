#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

/// A folder whose files replace tables that are built into the program: a file replaces the table
/// of the same name. A plain value; thread: any.
class TableFolder {
 public:
  /// With an empty `path` no table is replaced. Implicit: a path is a folder.
  TableFolder(std::string path = {}) : path_(std::move(path)) {}

  struct File {
    std::string path, text;
  };
  /// Returns the file that replaces `table`, such as "mixing.txt", or nothing if there is none.
  /// Errors: kUnavailable if the folder or the file cannot be read; those of ReadTableFile.
  vm::Result<std::optional<File>> Find(std::string_view table) const;
  /// Returns the folder's files that replace none of `tables`, sorted; hidden files are left out.
  std::vector<std::string> FilesBeside(std::span<const std::string_view> tables) const;
  const std::string& path() const { return path_; }
  bool empty() const { return path_.empty(); }

 private:
  std::string path_;
};

}  // namespace fsm
