#include "face_editor/core/identity_head.h"

#include <exception>

namespace editor {

vm::Result<std::shared_ptr<const fsm::Head>> MakeIdentityHead(const std::string& base,
                                                              const Sliders& sliders) {
  static_cast<void>(sliders);
  try {
    return std::shared_ptr<const fsm::Head>(fsm::Head::Make(base));
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, error.what());
  }
}

}  // namespace editor
