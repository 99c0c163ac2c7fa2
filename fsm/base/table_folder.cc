#include "fsm/base/table_folder.h"

#include <algorithm>
#include <filesystem>

#include "fsm/base/table_reader.h"

namespace fsm {

namespace fs = std::filesystem;

vm::Result<std::optional<TableFolder::File>> TableFolder::Find(std::string_view table) const {
  if (path_.empty()) return std::nullopt;
  std::error_code code;
  if (!fs::is_directory(path_, code)) {
    return vm::Fail(vm::Errc::kUnavailable, "'" + path_ + "' is not a folder of tables");
  }
  File file{path_ + "/" + std::string(table), ""};
  if (!fs::exists(file.path, code)) return std::nullopt;
  auto text = ReadTableFile(file.path);
  if (!text) return std::unexpected(std::move(text.error()));
  file.text = std::move(*text);
  return file;
}

std::vector<std::string> TableFolder::FilesBeside(std::span<const std::string_view> tables) const {
  std::vector<std::string> others;
  std::error_code code;
  for (fs::directory_iterator at(path_, code), end; !code && at != end; at.increment(code)) {
    std::string name = at->path().filename().string();
    if (name.starts_with('.') || !at->is_regular_file(code)) continue;
    if (std::ranges::find(tables, name) == tables.end()) others.push_back(std::move(name));
  }
  std::ranges::sort(others);
  return others;
}

}  // namespace fsm
