#include "face_editor/core/file_list.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <system_error>

#include "vm_protocol/core/lower_case.h"

namespace editor {
namespace {

bool EndsIn(const std::string& path, std::initializer_list<std::string_view> endings) {
  const std::string ending = vm::LowerCase(std::filesystem::path(path).extension().string());
  return std::ranges::find(endings, ending) != endings.end();
}

}  // namespace

bool IsHeadFile(const std::string& path) {
  return EndsIn(path, {".obj", ".glb", ".gltf", ".vrm", ".txt"});
}

bool IsKind(FileKind kind, const std::string& path) {
  const bool photo = EndsIn(path, {".jpg", ".jpeg", ".png"});
  switch (kind) {
    case FileKind::kPhotoOrHead:
      return photo || IsHeadFile(path);
    case FileKind::kPhoto:
      return photo;
    case FileKind::kTable:
      return EndsIn(path, {".txt"});
    case FileKind::kFolder:
      return false;
  }
  return false;
}

vm::Result<std::vector<FileEntry>> ListFiles(const std::string& folder, FileKind kind, bool all) {
  namespace fs = std::filesystem;
  std::vector<FileEntry> found;
  std::error_code error;
  fs::directory_iterator at(folder, error);
  for (; !error && at != fs::directory_iterator(); at.increment(error)) {
    FileEntry entry{at->path().filename().string()};
    std::error_code gone;  // it may go away meanwhile, or be a link to nowhere
    entry.folder = at->is_directory(gone);
    if (!all && (entry.name.starts_with('.') || (!entry.folder && !IsKind(kind, entry.name)))) {
      continue;
    }
    if (!entry.folder) entry.bytes = at->file_size(gone);
    if (gone) entry.bytes = 0;
    found.push_back(std::move(entry));
    if (found.size() > kMostEntries) {
      return vm::Fail(vm::Errc::kLimit, "'" + folder + "' holds more than " +
                                            std::to_string(kMostEntries) +
                                            " files; type the path of one");
    }
  }
  if (error) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "cannot read the folder '" + folder + "': " + error.message());
  }
  std::ranges::sort(found, [](const FileEntry& a, const FileEntry& b) {
    return a.folder != b.folder ? a.folder : a.name < b.name;
  });
  return found;
}

std::string WholePath(const std::string& folder, const std::string& path) {
  std::filesystem::path whole(path);
  const char* home = std::getenv("HOME");
  if (home && (path == "~" || path.starts_with("~/"))) whole = home + path.substr(1);
  if (whole.is_relative()) whole = std::filesystem::path(folder) / whole;
  std::error_code error;
  if (whole.is_relative()) whole = std::filesystem::absolute(whole, error);
  whole = whole.lexically_normal();
  // A folder's name ends without its slash.
  if (!whole.has_filename() && whole.has_relative_path()) whole = whole.parent_path();
  return whole.string();
}

}  // namespace editor
