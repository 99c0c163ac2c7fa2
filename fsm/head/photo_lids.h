#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/head/head.h"
#include "fsm/head/rig.h"

namespace fsm {

/// What a vertex of an upper lid looks like when the lid is shut.
struct LidPaint {
  std::uint32_t vertex;
  glm::vec3 screen;  ///< colour on the screen, 0..1
  float part;        ///< how much of it is lid, 0..1: it goes over into the skin round it
};

/// Lids for a face that wears a photo of open eyes, which shows of their skin only a fold and the
/// lashes: coloured like the skin above and below them, as far as that is not darker or brighter
/// than most of it (glasses, brows, reflections). `places` are HeadTopology::photo_place.
std::vector<LidPaint> PaintLids(const WornPhoto& photo, std::span<const glm::vec3> places,
                                std::span<const Flesh> skin);

}  // namespace fsm
