#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "face_editor/core/state.h"
#include "fsm/head/make_head.h"
#include "fsm/rig/head.h"
#include "vm_protocol/core/result.h"

namespace editor {

/// The sliders there are, and those a built-in face has set.
std::vector<std::string> SliderNames();
/// REQUIRES: one of fsm::Identities().
Sliders SlidersOf(const std::string& base);

/// A face made of a built-in one, as its file says; lines that are no sliders are kept as they are.
struct OwnFace {
  std::string base;
  Sliders sliders;
  std::string other;
};
/// Error: kBadValue with file and line.
vm::Result<OwnFace> ReadOwnFace(const std::string& path, std::string_view text);
std::string WriteOwnFace(const OwnFace& face);

/// A built-in face with its sliders set. Error: kBadValue for an unknown face or slider.
vm::Result<std::shared_ptr<const fsm::Head>> MakeIdentityHead(const std::string& base,
                                                              const Sliders& sliders);

}  // namespace editor
