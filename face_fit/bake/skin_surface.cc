#include "face_fit/bake/skin_surface.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "face_fit/surface/triangles.h"
#include "fsm/head/photo_wear.h"

namespace facefit {

VisibleSurface SeenSkin(const FittedHead& fitted, const CameraPose& pose, const SampleGrid& grid,
                        float bottom) {
  constexpr float kLeastFacing = 0.1F;  // cosine of the slant to the camera's axis
  const auto& posed = fitted.posed_vertices;
  const glm::vec3 axis = pose.TowardsCamera();
  VisibleSurface surface(grid, pose.Screen(posed));
  ForSkinTriangles(fitted.base->head->topology(), [&](const std::uint32_t* t) {
    const auto beyond = [&](std::uint32_t v) {
      return posed[v].y < bottom || posed[v].z < fsm::JawLine(posed[v].y - bottom);
    };
    if (std::any_of(t, t + 3, beyond)) return;
    const glm::vec3 n = glm::cross(posed[t[1]] - posed[t[0]], posed[t[2]] - posed[t[0]]);
    if (glm::dot(n, axis) > kLeastFacing * glm::length(n)) surface.Draw(t);
  });
  return surface;
}

}  // namespace facefit
