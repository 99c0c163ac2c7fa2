#pragma once

#include <cstdint>
#include <optional>

#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/rig/pbr_material.h"

namespace fsm {

/// The reflection of light by a glTF material, and its textures.
struct GltfMaterial {
  /// A reference to a texture; index -1: none.
  struct Texture {
    std::int64_t index = -1;
    float strength = 1;
    /// The reference to it, valid as long as the document.
    const nlohmann::json* reference = nullptr;
  };
  std::optional<PbrMaterial> pbr;  ///< none: unlit (KHR_materials_unlit, or no material)
  Texture normal, metallic_roughness, occlusion, emissive;
  enum class Alpha { kOpaque, kMask, kBlend } alpha = Alpha::kOpaque;
};

/// Reads a metallic-roughness or MToon material (VRMC_materials_mtoon 1.0, materialProperties of
/// VRM 0.x).
GltfMaterial ReadMaterial(const GltfDocument& document, std::int64_t material);

}  // namespace fsm
