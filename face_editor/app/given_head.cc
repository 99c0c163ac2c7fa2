#include "face_editor/app/given_head.h"

#include <exception>
#include <utility>
#include <vector>

#include "fsm/faces/head_of_file.h"
#include "fsm/faces/original_config.h"
#include "fsm/faces/original_faces.h"

namespace editor {
namespace {

vm::Result<MadeHead> OpenOriginal(const std::string& path, const std::string& face,
                                  const std::string& tables) {
  const auto config = fsm::OriginalConfig::Read(path);
  if (!config) return std::unexpected(config.error());
  const auto [faces, left_out] = fsm::OriginalFaces(config->faces, config->shared, tables);
  std::string names;
  for (const fsm::NamedFace& one : faces) {
    names += (names.empty() ? "" : ", ") + one.name;
    if (!face.empty() && one.name != face) continue;
    MadeHead made;
    made.head = one.make();
    made.notice = "Face '" + one.name + "' of " + path;
    if (!left_out.empty()) made.notice += "; not all others can be had: " + left_out.front();
    return made;
  }
  if (!names.empty()) {
    return vm::Fail(vm::Errc::kBadValue, path + " has no face '" + face + "'; it has " + names);
  }
  return vm::Fail(vm::Errc::kBadValue,
                  left_out.empty() ? path +
                                         " names no face (MaskFile), as a configuration of the "
                                         "original would"
                                   : left_out.front());
}

}  // namespace

vm::Result<MadeHead> OpenHead(const std::string& path, const std::string& face,
                              const std::string& tables) {
  try {
    if (path.ends_with(".txt")) return OpenOriginal(path, face, tables);
    MadeHead made;
    fsm::FileHead file = fsm::MakeHeadOfFile(path, tables);
    made.head = std::move(file.head);
    made.notice = file.notice.empty() ? "Head of " + path : file.notice;
    if (file.by_shapes) {
      made.remake = [path, tables](const fsm::UnitTable& units) {
        return fsm::MakeHeadOfFile(path, tables, units).head;
      };
    }
    return made;
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, error.what());
  }
}

}  // namespace editor
