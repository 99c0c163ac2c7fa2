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

/// Where a material's picture lies on a mesh: v = turn * (size * uv) + move
/// (KHR_texture_transform).
struct GltfUv {
  std::int64_t set = 0;  ///< TEXCOORD_set
  glm::vec2 move{0}, size{1};
  float turn_rad = 0;
  glm::vec2 operator()(glm::vec2 uv) const;
  bool operator==(const GltfUv&) const = default;
};

/// Gives the parts of a head the colours and pictures of a glTF file's materials. What a material
/// does to its picture (factor, cut-off, no transparency) is done to a copy, so that a part needs
/// nothing but its picture; the pictures of light (GltfMaterial) are put together to two beside it.
class GltfPaint {
 public:
  /// `document` and `head` outlive it.
  GltfPaint(const GltfDocument& document, ImportedHead& head) : document_(document), head_(head) {}
  void ApplyMaterial(std::int64_t material, ImportedHead::Part& part);
  /// The settings of a material's picture.
  GltfUv UvOfMaterial(std::int64_t material) const;

 private:
  /// Image, factor in steps of 1/255, cut-off (-1 opaque, 256 smooth), material if its light has
  /// pictures of its own.
  using Key = std::tuple<std::int64_t, std::uint32_t, int, std::int64_t>;
  int Picture(const Key& key, glm::vec4 factor, ImportedHead::Detail detail);
  std::int64_t ImageOf(std::int64_t texture);
  std::optional<Image> Decode(std::int64_t image);
  /// The pictures of light, where they lie on the mesh as `uv` says.
  ImportedHead::Detail DetailOf(const GltfMaterial& given, const GltfUv& uv);

  const GltfDocument& document_;
  ImportedHead& head_;
  std::map<Key, int> picture_of_;
  std::map<std::int64_t, int> pbr_index_;  // of materials
  std::size_t detailed_ = 0;
};

}  // namespace fsm
