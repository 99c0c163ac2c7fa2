#include "face_editor/core/identity_head.h"

#include <algorithm>
#include <exception>

#include "fsm/head/identity.h"
#include "fsm/head/make_head.h"

namespace editor {

std::vector<std::string> SliderNames() { return fsm::SliderNames(); }

Sliders SlidersOf(const std::string& base) {
  Sliders sliders;
  for (const auto& [name, value] : fsm::BuiltInIdentity(base).sliders) sliders[name] = value;
  return sliders;
}

vm::Result<OwnFace> ReadOwnFace(const std::string& path, std::string_view text) {
  try {
    OwnFace face;
    const fsm::Identity identity = fsm::ReadOwnIdentity(path, text);
    face.base = fsm::Identities()[identity.index];
    for (const auto& [name, value] : identity.sliders) face.sliders[name] = value;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      const std::string line(text.substr(at, end - at));
      at = end + 1;
      const fsm::Table words(path, line);
      const std::string key = words.rows().empty() ? "" : words.rows()[0].key();
      if (!key.empty() && key != "base" && key != "slider") face.other += line + "\n";
    }
    return face;
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, error.what());
  }
}

std::string WriteOwnFace(const OwnFace& face) {
  return fsm::WriteOwnIdentity(face.base, face.sliders) + face.other;
}

vm::Result<std::shared_ptr<const fsm::Head>> MakeIdentityHead(const std::string& base,
                                                              const Sliders& sliders) {
  try {
    const OwnFace face{base, sliders, ""};
    return std::shared_ptr<const fsm::Head>(
        fsm::MakeHead(fsm::ReadOwnIdentity("face", WriteOwnFace(face))));
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, error.what());
  }
}

}  // namespace editor
