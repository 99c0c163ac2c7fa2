#pragma once

#include <cstdint>
#include <vector>

#include "fsm/head/anatomy.h"
#include "fsm/head/identity.h"
#include "fsm/head/mesh_builder.h"
#include "fsm/head/subdivide.h"

namespace fsm {

/// Adds the subdivided skin with paint and rig to an empty mesh; vertex i of the skin becomes
/// vertex i of the mesh. Returns the landmarks of the mouth, to which FindIncisors adds.
MouthVertices BuildSkin(const FineSkin& skin, const EyeAnatomy& eye, const MouthAnatomy& mouth,
                        const Identity& identity, MeshBuilder& mesh);

/// The front of the skin as seen from the viewer, on which other parts are placed.
class SkinFront {
 public:
  explicit SkinFront(const FineSkin& skin);
  /// Returns the frontmost point at (x, y), or the closest vertex if there is no skin.
  glm::vec3 PointAt(glm::vec2 xy) const;
  /// Returns the texture coordinates of that point, or of its mirror image on the right.
  glm::vec2 UvAt(glm::vec2 xy, Side side) const;

 private:
  static constexpr int kCells = 64;  // along each side of a square about the origin
  static constexpr float kCellMm = 6.0f;
  static std::size_t Cell(float mm);

  const FineSkin& skin_;
  std::vector<std::uint32_t> front_;               ///< triangles that face the viewer
  std::vector<std::vector<std::uint32_t>> cells_;  ///< those that touch a cell, row by row
};

}  // namespace fsm
