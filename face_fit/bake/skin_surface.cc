#include "face_fit/bake/skin_surface.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "face_fit/surface/triangles.h"
#include "fsm/head/photo_surface.h"

namespace facefit {

VisibleSurface VisibleSkin(const FittedHead& fitted, const CameraPose& pose, const SampleGrid& grid,
                           float bottom_mm) {
  constexpr float kMinFacing = 0.1F;  // cosine of the normal's angle to the camera's axis
  const auto& vertices = fitted.vertices;
  const glm::vec3 axis = pose.TowardsCamera();
  const auto beyond = [&](std::uint32_t v) {
    return vertices[v].y < bottom_mm || vertices[v].z < fsm::NeckFrontZ(vertices[v].y - bottom_mm);
  };
  VisibleSurface surface(grid, pose.ToScreen(vertices));
  ForEachSkinAndLipTriangle(fitted.base->surface(), [&](const MeshTriangle& triangle) {
    if (std::ranges::any_of(triangle.corner, beyond)) return;
    const glm::vec3 normal = triangle.Normal(vertices);
    if (glm::dot(normal, axis) > kMinFacing * glm::length(normal)) surface.Draw(triangle);
  });
  return surface;
}

}  // namespace facefit
