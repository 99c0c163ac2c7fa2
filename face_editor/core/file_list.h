#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"

namespace editor {

/// What a file is opened for; told by its ending.
enum class FileKind { kPhotoOrHead, kPhoto, kTable, kFolder };
bool IsKind(FileKind kind, const std::string& path);
/// A head from elsewhere or a configuration of the original.
bool IsHeadFile(const std::string& path);

struct FileEntry {
  std::string name;
  bool folder = false;
  std::uintmax_t bytes = 0;
};
/// What lies in a folder: folders first, then files of the kind (all of them with `all`), each by
/// name; hidden ones only with `all`. Errors: kUnavailable if it cannot be read; kLimit if it holds
/// more than kMostEntries.
vm::Result<std::vector<FileEntry>> ListFiles(const std::string& folder, FileKind kind, bool all);
inline constexpr std::size_t kMostEntries = 20000;

/// `path` from `folder` if it is relative, without . and ..; "~" is the user's own folder.
std::string WholePath(const std::string& folder, const std::string& path);

}  // namespace editor
