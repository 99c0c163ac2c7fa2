// The page of identity: a built-in face made into somebody else by sliders.

#include "face_editor/app/ui.h"

namespace editor {

fsm::FaceState IdentityPage(Ui& ui) {
  TryIt(ui);
  return {};
}

}  // namespace editor
