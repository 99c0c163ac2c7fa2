#include "fsm/faces/face_folder.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "fsm/image/image_file.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/core/user_folder.h"

namespace fsm {

std::string FacesFolder() {
  const std::string own = vm::Environment("GALATEA_FACES");
  return own.empty() ? vm::UserFolder("XDG_DATA_HOME", ".local/share") + "/faces" : own;
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
  for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::string name = entry->path().filename().string();
    const auto has = [&](const char* file) {
      std::error_code unreadable;
      return std::filesystem::exists(entry->path() / file, unreadable);
    };
    if (IsFaceName(name) && (has("face.txt") || has("identity.txt"))) {
      names.push_back(std::move(name));
    }
  }
  std::ranges::sort(names);
  return names;
}

vm::Result<std::string> WriteFace(const PhotoHead& head, std::string_view report,
                                  const std::string& folder, const std::string& name) {
  if (!IsFaceName(name)) {
    return vm::Fail(vm::Errc::kBadValue, "'" + name.substr(0, 70) +
                                             "' cannot be a face's name: letters, digits, - and _ "
                                             "expected, as anna");
  }
  const std::string place = (folder.empty() ? FacesFolder() : folder) + "/" + name;
  std::error_code code;
  std::filesystem::create_directories(place, code);
  auto done = WriteImage(*head.atlas, place + "/photo.png");
  if (done) done = vm::WriteTextFile(place + "/report.txt", report);
  if (done) done = vm::WriteTextFile(place + "/face.txt", WritePhotoHead(head));
  if (!done) return std::unexpected(done.error());
  return place;
}

}  // namespace fsm
