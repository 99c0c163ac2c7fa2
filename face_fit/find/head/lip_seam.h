#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "face_fit/surface/mesh_point.h"
#include "fsm/rig/head.h"

namespace facefit {

/// The lip seam of a head, the line where closed lips meet, seen from the front: points that are
/// neighbours in the view but far apart along the surface. Parted lips have an upper and a lower
/// edge.
struct LipSeam {
  struct Edges {
    MeshPoint upper, lower;
  };
  std::vector<Edges> columns;  ///< at equal steps from the head's right corner to its left
  /// Returns the edges at a position: 0 = right corner, 1 = left corner.
  const Edges& EdgesAt(float along) const {
    return columns[static_cast<std::size_t>(
        std::lround(along * static_cast<float>(columns.size() - 1)))];
  }
};

/// Finds the lip seam of a head that faces +z, millimetres; nothing if there is none of 20 to 90
/// mm. `skin_triangles`: of skin, lips and mouth; `has_uv_seams`: as for fsm::TransferSurface;
/// `upper`, `lower`: positions on the outer edges of the lips.
std::optional<LipSeam> FindLipSeam(const fsm::HeadSurface& mesh,
                                   const std::vector<glm::vec3>& position,
                                   const std::vector<std::uint32_t>& skin_triangles,
                                   bool has_uv_seams, std::span<const glm::vec3> upper,
                                   std::span<const glm::vec3> lower);

}  // namespace facefit
