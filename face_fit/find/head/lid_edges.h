#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "face_fit/surface/mesh_point.h"
#include "fsm/rig/head.h"

namespace facefit {

/// The opening of an eye seen from the front: where flesh ends and the eyeball begins. On a mesh it
/// is known exactly; the landmark network guesses it from an image and is off by a good part of a
/// lid.
struct LidEdges {
  static constexpr std::size_t kBetween = 7;
  MeshPoint outer, inner;  ///< corners
  /// At equal steps from the outer to the inner corner.
  std::array<MeshPoint, kBetween> upper, lower;
};

/// Returns the opening of an eye, or nothing if there is none of 10 to 60 mm. `is_eye`: for each
/// vertex whether it belongs to an eyeball. The head faces +z, millimetres.
std::optional<LidEdges> FindLidEdges(const fsm::Head& head, const std::vector<glm::vec3>& position,
                                     const std::vector<bool>& is_eye, fsm::Side side);

/// Returns for each vertex whether it belongs to an eyeball by its material.
std::vector<bool> EyeVertices(const fsm::HeadSurface& surface);

}  // namespace facefit
