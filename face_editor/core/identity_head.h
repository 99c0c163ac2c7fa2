#pragma once

#include <memory>
#include <string>
#include <vector>

#include "face_editor/core/state.h"
#include "fsm/head/head.h"
#include "vm_protocol/core/result.h"

namespace editor {

/// A built-in face with its sliders set. Error: kBadValue for an unknown face or slider.
vm::Result<std::shared_ptr<const fsm::Head>> MakeIdentityHead(const std::string& base,
                                                              const Sliders& sliders);

}  // namespace editor
