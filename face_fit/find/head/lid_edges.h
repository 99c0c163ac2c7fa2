#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "face_fit/surface/mesh_point.h"
#include "fsm/rig/head.h"

namespace facefit {

/// The opening of an eye as it is seen from the front: where flesh ends and the eyeball begins. On
/// a head of triangles that is known exactly, whereas the landmark network guesses it from a
/// picture and is off by a good part of a lid.
struct LidEdges {
  static constexpr std::size_t kBetween = 7;
  MeshPoint outer, inner;  ///< corners
  /// At equal parts of the way from the outer to the inner corner.
  std::array<MeshPoint, kBetween> upper, lower;
};

/// The opening of the eye on that side. `is_eye`: of each vertex, whether it is an eyeball's. The
/// head looks to +z, millimetres. Returns nothing if there is no opening of 10 to 60 mm.
std::optional<LidEdges> FindLidEdges(const fsm::HeadTopology& topology,
                                     const std::vector<glm::vec3>& position,
                                     const std::vector<bool>& is_eye, fsm::Side side);

/// For each vertex of a head whether it is an eyeball's by its material.
std::vector<bool> EyeVertices(const fsm::HeadTopology& topology);

}  // namespace facefit
