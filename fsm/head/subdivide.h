#pragma once

#include "fsm/head/cage.h"

namespace fsm {

/// A complete skin as triangles.
struct FineSkin {
  struct Triangle {
    std::array<std::uint32_t, 3> corner;
    SkinKind kind;
  };
  std::vector<glm::vec3> position;
  std::vector<CageTag> tag;
  std::vector<Triangle> triangles;
  /// By cage point of the left half: the vertex that lies where the table put the point.
  std::vector<std::uint32_t> of_cage;
};

/// Subdivides the cage and its mirror image by one step of Catmull and Clark (1978), with creases
/// along the lip seam and open edges. The cage is corrected first, so that the result interpolates
/// its points. Plain faces are only triangulated.
FineSkin Subdivide(const Cage& half);

}  // namespace fsm
