#pragma once

#include <glm/vec2.hpp>
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
  /// Skin that lends its grain: below the lower lid, as far from the line in which the lids meet.
  glm::vec2 lender;    ///< its place in the photo, as HeadTopology::photo_place
  float lender_light;  ///< the mean brightness round it, 0..1
  /// From its place in the photo to where in the photo it comes to lie.
  glm::vec2 slide;
};

/// What a photo shows at a place (u, v down), on the screen, 0..1.
glm::vec3 PhotoColour(const WornPhoto& photo, glm::vec2 place);

/// Lids for a face that wears a photo of open eyes. A lid that shuts comes out from under the skin
/// above it: what the photo shows there, a fold or a rim of glasses, stays where it is, and the eye
/// gives way to skin coloured like that above and below, as far as that is not darker or brighter
/// than most of it (glasses, brows, reflections), with the grain of the lower lid's. `places` are
/// HeadTopology::photo_place; `open` and `shut`: where the vertices lie with lids at rest and
/// shut, millimetres. All four of one length.
std::vector<LidPaint> PaintLids(const WornPhoto& photo, std::span<const glm::vec3> places,
                                std::span<const Flesh> skin, std::span<const glm::vec3> open,
                                std::span<const glm::vec3> shut);

}  // namespace fsm
