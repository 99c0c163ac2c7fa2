#include "fsm/head/face_folder.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace fsm {

std::string FacesFolder() {
  const auto named = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value ? value : "");
  };
  if (const auto own = named("GALATEA_FACES"); !own.empty()) return own;
  if (const auto data = named("XDG_DATA_HOME"); !data.empty()) return data + "/galatea/faces";
  return named("HOME") + "/.local/share/galatea/faces";
}

bool IsFaceName(std::string_view name) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return !name.empty() && name.size() <= 64 && std::ranges::all_of(name, fits);
}

std::vector<std::string> FacesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    std::string name = entry.path().filename().string();
    const auto has = [&](const char* file) {
      return std::filesystem::exists(entry.path() / file, error);
    };
    if (IsFaceName(name) && (has("face.txt") || has("identity.txt"))) {
      names.push_back(std::move(name));
    }
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace fsm
