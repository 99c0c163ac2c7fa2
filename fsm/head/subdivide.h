#pragma once

#include "fsm/head/cage.h"

namespace fsm {

/// A whole skin as triangles.
struct FineSkin {
  struct Triangle {
    std::array<std::uint32_t, 3> corner;
    SkinKind kind;
  };
  std::vector<glm::vec3> position;
  std::vector<CageTag> tag;
  std::vector<Triangle> triangles;
  /// For points of the cage on the left half: the vertex that stands where the table put it.
  std::vector<std::uint32_t> of_cage;
};

/// The cage and its mirror image after one step of Catmull and Clark (1978), sharp along the seam
/// of the lips and open edges. The cage is first corrected, so that the result goes through the
/// cage's points. Plain faces are only triangulated.
FineSkin Subdivide(const Cage& half);

}  // namespace fsm
