#include "fsm/app/head_wardrobe.h"

#include <algorithm>

#include "fsm/base/caught.h"
#include "fsm/faces/face_folder.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/head/identity.h"

namespace fsm {

std::vector<std::string> HeadWardrobe::Faces() const {
  std::vector<std::string> names;
  for (const NamedFace& more : more_) names.push_back(more.name);
  for (const auto& others : {Identities(), FacesIn(FacesFolder())}) {
    for (const std::string& name : others) {
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

const Head& HeadWardrobe::head() {
  if (!head_) head_ = Make(worn_);
  return *head_;
}

/// Makes one of the given faces, a built-in head, or one of FacesFolder; "" = the first.
std::unique_ptr<Head> HeadWardrobe::Make(const std::string& face) const {
  for (const NamedFace& more : more_) {
    if (face.empty() || more.name == face) return more.make();
  }
  return MakeHeadOfName(face.empty() ? Identities().front() : face, tables_);
}

vm::Result<void> HeadWardrobe::Wear(const std::string& face) {
  const std::vector<std::string> names = Faces();
  if (std::ranges::find(names, face) == names.end()) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : " ") + name;
    return vm::Fail(vm::Errc::kBadValue, "there is no face '" + face + "'; " + list + " expected");
  }
  if (face == (worn_.empty() ? names.front() : worn_)) return {};
  return Caught("", [&] {
    head_ = Make(face);
    worn_ = face;
  });
}

vm::Result<MouthMeasure> HeadWardrobe::Measure(const FaceState& state) {
  return Caught("cannot measure: ", [&] { return head().MeasureMouth(state); });
}

}  // namespace fsm
