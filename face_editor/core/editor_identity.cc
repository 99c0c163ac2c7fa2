// Identity: the sliders of a built-in face, and the files of faces made so.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "face_editor/core/editor.h"
#include "face_editor/core/identity_head.h"
#include "face_editor/core/table_writer.h"
#include "fsm/base/table_reader.h"
#include "fsm/faces/face_folder.h"
#include "fsm/head/make_head.h"
#include "vm_protocol/core/text_file.h"

namespace editor {

using vm::Errc;
using vm::Fail;

namespace {

constexpr float kMost = 10;

vm::Result<std::string> FolderOf(const std::string& name, const std::string& folder) {
  if (fsm::IsFaceName(name)) return (folder.empty() ? fsm::FacesFolder() : folder) + "/" + name;
  return Fail(Errc::kBadValue, "'" + name.substr(0, 70) +
                                   "' cannot be a face's name: letters, digits, - and _ expected, "
                                   "as anna");
}

}  // namespace

vm::Result<void> Editor::SetBase(std::string_view name) {
  if (!fsm::IsBuiltIn(name)) {
    return Fail(Errc::kBadValue,
                fmt::format("there is no built-in face '{}'; {} expected", name.substr(0, 40),
                            fmt::join(fsm::Identities(), ", ")));
  }
  const std::string base(name);
  history_.Change(Part::kIdentity, "face " + base, "", [&](State& state) {
    state.base = base;
    state.sliders = SlidersOf(base);
  });
  return {};
}

vm::Result<void> Editor::SetSlider(std::string_view name, float value, std::string_view merge) {
  const auto names = SliderNames();
  if (std::ranges::find(names, name) == names.end()) {
    std::string list;
    for (const auto& other : names) list += " " + other;
    return Fail(Errc::kBadValue, fmt::format("there is no slider '{}'; one of{} expected",
                                             name.substr(0, 40), list));
  }
  if (!(std::abs(value) <= kMost)) return Fail(Errc::kBadValue, "-10 to 10 expected");
  history_.Change(Part::kIdentity, std::string(name), merge,
                  [&](State& state) { state.sliders.insert_or_assign(std::string(name), value); });
  return {};
}

vm::Result<void> Editor::LoadIdentity(const std::string& name, const std::string& folder) {
  const auto place = FolderOf(name, folder);
  if (!place) return std::unexpected(place.error());
  const std::string path = *place + "/identity.txt";
  const auto text = fsm::ReadTableFile(path);
  if (!text) return std::unexpected(text.error());
  auto face = ReadOwnFace(path, *text);
  if (!face) return std::unexpected(face.error());
  identity_other_ = std::move(face->other);
  history_.Change(Part::kIdentity, "face " + name, "", [&](State& state) {
    state.base = face->base;
    state.sliders = face->sliders;
  });
  MarkSaved(Part::kIdentity);
  return {};
}

vm::Result<std::string> Editor::SaveIdentity(const std::string& name, const std::string& folder) {
  const auto place = FolderOf(name, folder);
  if (!place) return place;
  std::error_code code;
  if (std::filesystem::exists(*place + "/face.txt", code)) {
    return Fail(Errc::kBadValue, "'" + name + "' is a face from a photo; another name expected");
  }
  std::filesystem::create_directories(*place, code);
  const std::string text = WriteOwnFace({state().base, state().sliders, identity_other_});
  if (auto done = vm::WriteTextFile(*place + "/identity.txt", text); !done) {
    return std::unexpected(done.error());
  }
  MarkSaved(Part::kIdentity);
  return *place;
}

}  // namespace editor
