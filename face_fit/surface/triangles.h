#pragma once

#include <algorithm>
#include <cstdint>

#include "fsm/rig/head_asset.h"

namespace facefit {

/// The material of a triangle, which is part of `topology.indices`.
inline fsm::Material MaterialOf(const fsm::HeadTopology& topology, const std::uint32_t* triangle) {
  const auto index = static_cast<std::uint32_t>(triangle - topology.indices.data());
  return std::ranges::find_if(
             topology.parts,
             [index](const auto& part) { return index - part.first_index < part.index_count; })
      ->material;
}

/// Calls `f(corners)` with the three vertices of each triangle whose material is kept.
template <typename Keep, typename F>
void ForTriangles(const fsm::HeadTopology& topology, Keep keep_material, F f) {
  for (const auto& part : topology.parts) {
    if (!keep_material(part.material)) continue;
    const auto corners = topology.Corners(part);
    for (std::size_t k = 0; k + 2 < corners.size(); k += 3) f(&corners[k]);
  }
}

/// Likewise for skin and lips.
template <typename F>
void ForSkinTriangles(const fsm::HeadTopology& topology, F f) {
  ForTriangles(
      topology,
      [](fsm::Material m) { return m == fsm::Material::kSkin || m == fsm::Material::kLip; }, f);
}

}  // namespace facefit
