#include "face_fit/bake/skin_rasterizer.h"

#include <glm/geometric.hpp>

#include "face_fit/find/head/rasterizer.h"
#include "fsm/head/photo_wear.h"

namespace facefit {

SkinRaster RasterizeSkin(const BaseHead& base, const FittedHead& fitted, const CameraPose& pose,
                         const PhotoGrid& grid, float bottom, std::span<const glm::vec3> motion) {
  const FloatImage none(grid.columns, grid.rows);
  SkinRaster out{FloatImage(grid.columns, grid.rows, SkinRaster::kNone), {none, none, none}};
  ForSkinTriangles(base.head->topology(), [&](const std::uint32_t* t) {
    glm::vec3 q[3];
    glm::vec2 p[3];
    for (int c = 0; c < 3; ++c) {
      const glm::vec3 v = fitted.posed_vertices[t[c]];
      if (v.y < bottom || v.z < fsm::JawLine(v.y - bottom)) return;
      q[c] = pose.ToCamera(v);
      p[c] = (pose.Project(q[c]) - grid.origin) / grid.cell;
    }
    const glm::vec3 n = glm::cross(q[1] - q[0], q[2] - q[0]);
    if (n.z <= 0.1F * glm::length(n)) return;
    Rasterize({p[0], p[1], p[2]}, grid.columns, grid.rows, 0.01F, [&](int x, int y, glm::vec3 w) {
      const float z = w.x * q[0].z + w.y * q[1].z + w.z * q[2].z;
      const std::size_t i = out.depth.Index(x, y);
      if (z <= out.depth.at[i]) return;
      out.depth.at[i] = z;
      if (motion.empty()) return;
      const glm::vec3 by = Interpolated(motion, t, w);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        out.motion[axis].at[i] = by[static_cast<int>(axis)];
      }
    });
  });
  return out;
}

}  // namespace facefit
