#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/head_mesh.h"
#include "fsm/head/identity.h"
#include "fsm/head/subdivide.h"

namespace fsm {

/// Where the lips part, in vertices of the skin.
struct MouthSeam {
  /// Seam vertices, upper and lower, of every column of the mouth's slit, from the viewer's left to
  /// right, corners excluded.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;
  std::uint32_t corner_left = 0, corner_right = 0;  ///< the agent's
  std::uint32_t mid_column = 0;                     ///< index into `seam` of the median
};

/// Adds the subdivided skin to an empty mesh with paint and rig; vertex i of the skin becomes
/// vertex i of the mesh.
MouthSeam BuildSkin(const FineSkin& skin, const EyeAnatomy& eye, const MouthAnatomy& mouth,
                    const Identity& identity, HeadMesh& mesh);

/// The skin's front as seen from the viewer, for what is laid on it.
class SkinFront {
 public:
  explicit SkinFront(const FineSkin& skin);
  /// The foremost point at (x, y) and the unit normal there; the nearest vertex where there is no
  /// skin.
  glm::vec3 PointAt(glm::vec2 xy, glm::vec3& normal) const;

 private:
  static constexpr int kCells = 64;  // along each side of a square about the origin
  static constexpr float kCellMm = 6.0f;
  static std::size_t Cell(float mm);

  const FineSkin& skin_;
  std::vector<std::uint32_t> front_;               ///< triangles that face the viewer
  std::vector<std::vector<std::uint32_t>> cells_;  ///< those that touch a cell, row after row
};

}  // namespace fsm
