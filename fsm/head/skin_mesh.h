#pragma once

#include <cstdint>
#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"
#include "fsm/head/subdivide.h"

namespace fsm {

/// Adds the subdivided skin to an empty mesh with paint and rig; vertex i of the skin becomes
/// vertex i of the mesh. Returns where the lips part: the median is the middle of the seam. The
/// teeth are still to be found (FindIncisors).
MouthSlit BuildSkin(const FineSkin& skin, const EyeAnatomy& eye, const MouthAnatomy& mouth,
                    const Identity& identity, HeadMesh& mesh);

/// The skin's front as seen from the viewer, for what is laid on it.
class SkinFront {
 public:
  explicit SkinFront(const FineSkin& skin);
  /// The foremost point at (x, y); the nearest vertex where there is no skin.
  glm::vec3 PointAt(glm::vec2 xy) const;
  /// The texture coordinates of that point, or of its mirror image on the right.
  glm::vec2 UvAt(glm::vec2 xy, Side side) const;

 private:
  static constexpr int kCells = 64;  // along each side of a square about the origin
  static constexpr float kCellMm = 6.0f;
  static std::size_t Cell(float mm);

  const FineSkin& skin_;
  std::vector<std::uint32_t> front_;               ///< triangles that face the viewer
  std::vector<std::vector<std::uint32_t>> cells_;  ///< those that touch a cell, row after row
};

}  // namespace fsm
