#pragma once

#include <cmath>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "face_fit/surface/mesh_point.h"
#include "fsm/rig/head.h"

namespace facefit {

/// The line where closed lips meet, as it is seen from the front: two places side by side in the
/// view that lie far apart along the surface. Parted lips have an upper and a lower edge.
struct LipSeam {
  struct Edges {
    MeshPoint upper, lower;
  };
  std::vector<Edges> columns;  ///< at even steps from the agent's right corner to the left one
  /// `along`: 0 at the right corner, 1 at the left one.
  const Edges& EdgesAt(float along) const {
    return columns[static_cast<std::size_t>(
        std::lround(along * static_cast<float>(columns.size() - 1)))];
  }
};

/// `skin_triangles`: those of skin, lips and mouth; `has_uv_seams` as for fsm::TransferSurface;
/// `upper`, `lower`: some places on the outer edges of both lips. The head looks to +z,
/// millimetres. Returns nothing if there is no seam of 20 to 90 mm.
std::optional<LipSeam> FindLipSeam(const fsm::HeadTopology& topology,
                                   const std::vector<glm::vec3>& position,
                                   const std::vector<std::uint32_t>& skin_triangles,
                                   bool has_uv_seams, std::span<const glm::vec3> upper,
                                   std::span<const glm::vec3> lower);

}  // namespace facefit
