#include "fsm/app/head_library.h"

#include <algorithm>

#include "fsm/base/catch_errors.h"
#include "fsm/faces/face_folder.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/head/identity.h"

namespace fsm {

std::vector<std::string> HeadLibrary::Faces() const {
  std::vector<std::string> names;
  for (const NamedFace& more : more_) names.push_back(more.name);
  for (const auto& others : {Identities(), FacesIn(FacesFolder())}) {
    for (const std::string& name : others) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

const Head& HeadLibrary::head() {
  if (!head_) head_ = Make(current_);
  return *head_;
}

/// Makes one of the given faces, a built-in head, or one of FacesFolder; "" = the first.
std::unique_ptr<Head> HeadLibrary::Make(const std::string& face) const {
  for (const NamedFace& more : more_) {
    if (face.empty() || more.name == face) return more.make();
  }
  return MakeHeadOfName(face.empty() ? Identities().front() : face, tables_);
}

vm::Result<void> HeadLibrary::Select(const std::string& face) {
  const std::vector<std::string> names = Faces();
  if (std::ranges::find(names, face) == names.end()) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : " ") + name;
    return vm::Fail(vm::Errc::kBadValue, "there is no face '" + face + "'; " + list + " expected");
  }
  if (face == (current_.empty() ? names.front() : current_)) return {};
  return CatchErrors("", [&] {
    head_ = Make(face);
    current_ = face;
  });
}

vm::Result<MouthMeasure> HeadLibrary::Measure(const FaceState& state) {
  return CatchErrors("cannot measure: ", [&] { return head().MeasureMouth(state); });
}

}  // namespace fsm
