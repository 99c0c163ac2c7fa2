#include "task_manager/platform/sound_keeper.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace vxml {
namespace {

/// What libsndfile goes by for headerless sounds; anything odd is left out.
std::string EndingOf(const std::string& uri) {
  const std::string path = uri.substr(0, uri.find_first_of("?#"));
  const std::string name = path.substr(path.find_last_of('/') + 1);
  const std::size_t dot = name.find_last_of('.');
  if (dot == std::string::npos || name.size() - dot > 6) return "";
  const std::string ending = name.substr(dot + 1);
  for (const char c : ending) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (!plain) return "";
  }
  return "." + ending;
}

}  // namespace

SoundKeeper::~SoundKeeper() {
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

void SoundKeeper::Clear() {
  std::error_code ignored;
  for (const auto& [uri, file] : kept_) std::filesystem::remove(file.first, ignored);
  kept_.clear();
  bytes_ = 0;
}

vm::Result<std::string> SoundKeeper::Folder() {
  if (!folder_.empty()) return folder_;
  std::error_code none;
  std::string name = std::filesystem::temp_directory_path(none) / "galatea-sounds-XXXXXX";
  if (none || ::mkdtemp(name.data()) == nullptr) {
    return vm::Fail(vm::Errc::kUnavailable, "no folder for sounds can be made");
  }
  folder_ = name;
  return folder_;
}

vm::Result<std::string> SoundKeeper::FileOf(const std::string& uri, const std::string& bytes) {
  const std::size_t hash = std::hash<std::string>()(bytes);
  if (const auto found = kept_.find(uri); found != kept_.end() && found->second.second == hash) {
    return found->second.first;
  }
  if (auto folder = Folder(); !folder) return folder;
  if (const auto old = kept_.find(uri); old != kept_.end()) {  // the same place, another sound
    std::error_code ignored;
    std::filesystem::remove(old->second.first, ignored);
  }
  if (kept_.size() >= kMaxFiles || bytes_ + bytes.size() > kMaxBytes) Clear();
  const std::string path = folder_ + "/" + std::to_string(++count_) + EndingOf(uri);
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  file.close();
  if (!file) return vm::Fail(vm::Errc::kUnavailable, path + ": cannot be written");
  kept_[uri] = {path, hash};
  bytes_ += bytes.size();
  return path;
}

}  // namespace vxml
