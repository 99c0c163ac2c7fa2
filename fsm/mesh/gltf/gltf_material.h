#pragma once

#include <cstdint>
#include <optional>

#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/rig/pbr_material.h"

namespace fsm {

/// What a material of a glTF file says of light, with the pictures it says it by.
struct GltfMaterial {
  /// A texture; -1: none.
  struct Texture {
    std::int64_t index = -1;
    float strength = 1;
    const nlohmann::json* where = nullptr;  ///< the reference to it, valid as long as the document
  };
  std::optional<PbrMaterial>
      pbr;  ///< nothing: shown as it is (KHR_materials_unlit, or no material)
  Texture normal, surface, open, glow;
  enum class Alpha { kOpaque, kMask, kBlend } alpha = Alpha::kOpaque;
};

/// A material of metal and roughness, or of MToon: VRMC_materials_mtoon 1.0 and
/// materialProperties of VRM 0.x.
GltfMaterial ReadMaterial(const GltfDocument& document, std::int64_t material);

}  // namespace fsm
