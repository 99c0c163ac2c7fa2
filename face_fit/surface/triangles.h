#pragma once

#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/rig/head_asset.h"

namespace facefit {

/// A triangle of a head: indices of its vertices, counter-clockwise from outside, and its material.
struct MeshTriangle {
  std::array<std::uint32_t, 3> corner{};
  fsm::Material material{};
  /// Returns the outward normal, whose length is twice the area. `position`: of each vertex.
  glm::vec3 Normal(const std::vector<glm::vec3>& position) const {
    return glm::cross(position[corner[1]] - position[corner[0]],
                      position[corner[2]] - position[corner[0]]);
  }
};

/// Calls `f` with each triangle whose material is kept.
template <typename Keep, typename F>
void ForEachTriangle(const fsm::HeadSurface& surface, Keep keep_material, F f) {
  for (const auto& part : surface.parts) {
    if (!keep_material(part.material)) continue;
    const auto corners = surface.Corners(part);
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3) {
      f(MeshTriangle{{corners[k], corners[k + 1], corners[k + 2]}, part.material});
    }
  }
}

/// Calls `f` with each triangle of skin and lips.
template <typename F>
void ForEachSkinAndLipTriangle(const fsm::HeadSurface& surface, F f) {
  ForEachTriangle(
      surface,
      [](fsm::Material m) { return m == fsm::Material::kSkin || m == fsm::Material::kLip; }, f);
}
/// Returns the corners of these triangles, three indices each.
inline std::vector<std::uint32_t> SkinAndLipCorners(const fsm::HeadSurface& surface) {
  std::vector<std::uint32_t> corners;
  ForEachSkinAndLipTriangle(surface, [&](const MeshTriangle& triangle) {
    corners.insert(corners.end(), triangle.corner.begin(), triangle.corner.end());
  });
  return corners;
}

}  // namespace facefit
