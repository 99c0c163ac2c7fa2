#include "face_fit/dress/cover.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "fsm/head/photo_wear.h"

namespace facefit {

SkinCover CoverWithSkin(const BaseHead& base, const Fit& fit, const PhotoGrid& grid, float bottom,
                        std::span<const glm::vec3> motion) {
  const FloatImage none(grid.columns, grid.rows);
  SkinCover out{FloatImage(grid.columns, grid.rows, SkinCover::kNone), {none, none, none}};
  const auto& topology = base.head->topology();
  for (const auto& part : topology.parts) {
    if (part.material != fsm::Material::kSkin && part.material != fsm::Material::kLip) continue;
    for (std::uint32_t k = part.first_index; k + 2 < part.first_index + part.index_count; k += 3) {
      const std::uint32_t* t = &topology.indices[k];
      glm::vec3 q[3];
      glm::vec2 p[3];
      bool low = false;
      for (int c = 0; c < 3; ++c) {
        const glm::vec3 v = fit.worn[t[c]];
        low = low || v.y < bottom || v.z < fsm::JawLine(v.y - bottom);
        q[c] = fit.pose.ToCamera(fit.worn[t[c]]);
        p[c] = (fit.pose.Project(q[c]) - grid.origin) / grid.cell;
      }
      const glm::vec3 n = glm::cross(q[1] - q[0], q[2] - q[0]);
      if (low || n.z <= 0.1F * glm::length(n)) continue;
      const float area =
          (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
      if (std::abs(area) < 1e-7F) continue;
      const glm::vec2 least = glm::max(glm::floor(glm::min(p[0], glm::min(p[1], p[2]))), 0.0F);
      const glm::vec2 most = glm::min(glm::ceil(glm::max(p[0], glm::max(p[1], p[2]))),
                                      glm::vec2(grid.columns - 1, grid.rows - 1));
      for (int y = static_cast<int>(least.y); y <= static_cast<int>(most.y); ++y) {
        for (int x = static_cast<int>(least.x); x <= static_cast<int>(most.x); ++x) {
          const glm::vec2 at(x, y);
          const float b =
              ((at.x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (at.y - p[0].y)) / area;
          const float c =
              ((p[1].x - p[0].x) * (at.y - p[0].y) - (at.x - p[0].x) * (p[1].y - p[0].y)) / area;
          if (b < -0.01F || c < -0.01F || b + c > 1.01F) continue;
          const float z = q[0].z * (1 - b - c) + q[1].z * b + q[2].z * c;
          const std::size_t i = out.depth.Index(x, y);
          if (z <= out.depth.at[i]) continue;
          out.depth.at[i] = z;
          if (motion.empty()) continue;
          const glm::vec3 by = motion[t[0]] * (1 - b - c) + motion[t[1]] * b + motion[t[2]] * c;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            out.motion[axis].at[i] = by[static_cast<int>(axis)];
          }
        }
      }
    }
  }
  return out;
}

void FillHoles(FloatImage& covered) {
  FloatImage outside(covered.width, covered.height);
  std::vector<std::pair<int, int>> open;
  const auto reach = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= covered.width || y >= covered.height) return;
    const std::size_t i = covered.Index(x, y);
    if (covered.at[i] > 0 || outside.at[i] > 0) return;
    outside.at[i] = 1;
    open.emplace_back(x, y);
  };
  for (int x = 0; x < covered.width; ++x) {
    reach(x, 0);
    reach(x, covered.height - 1);
  }
  for (int y = 0; y < covered.height; ++y) {
    reach(0, y);
    reach(covered.width - 1, y);
  }
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    reach(x + 1, y);
    reach(x - 1, y);
    reach(x, y + 1);
    reach(x, y - 1);
  }
  for (std::size_t i = 0; i < covered.at.size(); ++i) covered.at[i] = 1 - outside.at[i];
}

}  // namespace facefit
