#include "face_editor/core/face_name.h"

#include <filesystem>

#include "fsm/faces/face_folder.h"

namespace editor {

std::string FaceNameOf(std::string_view photo) {
  constexpr std::size_t kMostBytes = 64;
  std::string name;
  for (const char c : std::filesystem::path(photo).stem().string()) {
    const bool good = fsm::IsFaceName(std::string_view(&c, 1));
    if (good || (!name.empty() && name.back() != '_')) name += good ? c : '_';
    if (name.size() == kMostBytes) break;
  }
  while (name.ends_with('_')) name.pop_back();
  return name.empty() ? "face" : name;
}

}  // namespace editor
