#include "fsm/faces/head_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string_view>
#include <vector>

#include "fsm/asset/asset_reader.h"
#include "fsm/asset/asset_writer.h"
#include "fsm/base/catch_errors.h"
#include "fsm/base/random.h"
#include "fsm/faces/head_of_file.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxTables = 1000;  // greatest number of files in a folder of tables
constexpr std::string_view kNoticesFollow = "notices:\n";
/// The prefix of our files' names; other files in the folder are not touched.
constexpr const char* kEntry = ".galatea_head";

std::string SourceLine(const fs::path& path) {
  std::error_code code;
  const auto size = fs::file_size(path, code);
  const auto time = fs::last_write_time(path, code).time_since_epoch().count();
  return std::to_string(size) + " " + std::to_string(time) + " " + path.string() + "\n";
}

/// Returns the sources of a file's head with their sizes and times; "" if they cannot be
/// determined.
std::string SourcesOf(const std::string& path, const TableFolder& tables) {
  std::error_code code;
  const fs::path file = fs::canonical(path, code);
  if (code) return "";
  std::vector<std::string> lines{SourceLine("/proc/self/exe"), SourceLine(file),
                                 SourceLine(file.string() + ".points")};
  if (!tables.empty()) {
    for (fs::directory_iterator at(tables.path(), code), end; !code && at != end;
         at.increment(code)) {
      if (lines.size() > kMaxTables) return "";
      if (at->is_regular_file(code)) lines.push_back(SourceLine(at->path()));
    }
  }
  std::ranges::sort(lines);
  std::string sources;
  for (const std::string& line : lines) sources += line;
  return code ? "" : sources;
}

/// Tells whether all files in these lines have the same size and time as then.
bool Unchanged(std::string_view lines) {
  while (!lines.empty()) {
    const std::string line(lines.substr(0, lines.find('\n') + 1));
    lines.remove_prefix(line.size());
    const std::size_t path = line.find(' ', line.find(' ') + 1) + 1;
    if (path == 0 || line.size() < path + 1 ||
        line != SourceLine(line.substr(path, line.size() - path - 1)))
      return false;
  }
  return true;
}

std::string EntryName(const std::string& sources) {
  return fmt::format("{:016x}{}", HashOf(sources), kEntry);
}

std::string ReadAll(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::unique_ptr<Head> HeadCache::HeadOfFile(const std::string& path,
                                            const TableFolder& tables) const {
  const std::string sources = folder_.empty() ? "" : SourcesOf(path, tables);
  const std::string entry = folder_ + "/" + EntryName(sources);
  if (auto kept = sources.empty() ? nullptr : Find(entry, sources)) return kept;
  FileHead made = MakeHeadOfFile(path, tables);
  if (!made.notice.empty()) Notice(made.notice);
  if (sources.empty()) return std::move(made.head);
  std::string made_from = sources;
  for (const std::string& file : made.named_files) made_from += SourceLine(file);
  Keep(entry, made_from + std::string(kNoticesFollow) + made.notice, *made.head);
  return std::move(made.head);
}

std::unique_ptr<Head> HeadCache::Find(const std::string& entry, const std::string& sources) const {
  const std::string made_from = ReadAll(entry + ".txt");
  const std::size_t notices = made_from.find(kNoticesFollow);
  if (!made_from.starts_with(sources) || notices == std::string::npos ||
      !Unchanged(std::string_view(made_from).substr(sources.size(), notices - sources.size())))
    return nullptr;
  auto asset = ParseAsset(entry + ".glb", ReadAll(entry + ".glb"));
  if (!asset) {
    Notice("the head is baked anew, " + asset.error().text);
    return nullptr;
  }
  const std::string notice = made_from.substr(notices + kNoticesFollow.size());
  if (!notice.empty()) Notice(notice);
  return std::make_unique<Head>(std::move(*asset));
}

void HeadCache::Keep(const std::string& entry, const std::string& made_from,
                     const Head& head) const {
  const auto kept = CatchErrors("the head is not kept: ", [&] {
    fs::create_directories(folder_);
    DropOldest();
    vm::OrThrow(vm::WriteTextFile(entry + ".glb", WriteAsset(head, {})));
    vm::OrThrow(vm::WriteTextFile(entry + ".txt", made_from));
  });
  if (!kept) Notice(kept.error().text);
}

void HeadCache::DropOldest() const {
  // One of the two files may be missing if a program was killed between writing them.
  std::map<fs::path, fs::file_time_type> entries;
  for (const fs::directory_entry& file : fs::directory_iterator(folder_)) {
    const fs::path ending = file.path().extension();
    if ((ending != ".txt" && ending != ".glb") || !file.path().stem().string().ends_with(kEntry))
      continue;
    fs::file_time_type& time = entries[folder_ / file.path().stem()];
    time = std::max(time, file.last_write_time());
  }
  std::vector<std::pair<fs::file_time_type, fs::path>> kept;
  for (const auto& [entry, time] : entries) kept.emplace_back(time, entry);
  std::ranges::sort(kept);
  for (std::size_t i = 0; i + kMaxHeads <= kept.size(); ++i) {
    for (const char* ending : {".txt", ".glb"}) fs::remove(kept[i].second.string() + ending);
  }
}

}  // namespace fsm
