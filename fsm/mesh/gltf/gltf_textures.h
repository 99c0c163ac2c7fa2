#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <tuple>

#include "fsm/mesh/gltf/gltf_document.h"
#include "fsm/mesh/gltf/gltf_material.h"
#include "fsm/mesh/imported_head.h"

namespace fsm {

/// The texture coordinates of a material: rotation * (scale * uv) + offset (KHR_texture_transform).
struct GltfUvTransform {
  std::int64_t set = 0;  ///< TEXCOORD_set
  glm::vec2 offset{0}, scale{1};
  float rotation_rad = 0;
  glm::vec2 operator()(glm::vec2 uv) const;
  bool operator==(const GltfUvTransform&) const = default;
};

/// Sets the colours and pictures of a head's parts from the materials of a glTF file. Factor, alpha
/// cut-off and opacity of a material are applied to a copy of its picture, so that a part needs
/// nothing but that copy; the other textures (GltfMaterial) are combined into ImportedHead::Detail.
class GltfTextures {
 public:
  /// Lifetime: `document` and `head` outlive this.
  GltfTextures(const GltfDocument& document, ImportedHead& head)
      : document_(document), head_(head) {}
  void ApplyMaterial(std::int64_t material, ImportedHead::Part& part);
  /// Returns the texture coordinates of a material's picture.
  GltfUvTransform UvOfMaterial(std::int64_t material) const;

 private:
  /// Image, factor in steps of 1/255, alpha cut-off (-1 opaque, 256 blended), and the material if
  /// it has textures beside its picture.
  using Key = std::tuple<std::int64_t, std::uint32_t, int, std::int64_t>;
  int Picture(const Key& key, glm::vec4 factor, ImportedHead::Detail detail);
  std::int64_t ImageOf(std::int64_t texture);
  std::optional<Image> Decode(std::int64_t image);
  /// Combines the textures of a material beside its picture; those with texture coordinates other
  /// than `uv` are left out.
  ImportedHead::Detail DetailOf(const GltfMaterial& given, const GltfUvTransform& uv);

  const GltfDocument& document_;
  ImportedHead& head_;
  std::map<Key, int> picture_of_;
  std::map<std::int64_t, int> pbr_index_;  // by material
  std::size_t detailed_ = 0;
};

}  // namespace fsm
