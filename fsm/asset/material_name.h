#pragma once

#include <array>

#include "fsm/rig/head_asset.h"

namespace fsm {

/// Returns the name of a material in files and descriptions.
inline const char* MaterialName(Material material) {
  static constexpr std::array<const char*, kValuesOf<Material>> kNames{
      "skin",  "lips",   "eye_white", "eye_iris", "eye_pupil", "teeth",       "gums", "tongue",
      "mouth", "lashes", "hair",      "cloth",    "photo",     "shut_lashes", "matte"};
  return kNames[static_cast<std::size_t>(material)];
}

}  // namespace fsm
