#include "face_fit/bake/bust.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/find/head/rasterizer.h"
#include "face_fit/picture/filters.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {

float Bust::HalfWidth(std::size_t side, float row) const {
  const int y = std::clamp(static_cast<int>(row), 0, cover.height - 1);
  const int step = side == 0 ? -1 : 1;
  int x = std::clamp(static_cast<int>(axis), 0, cover.width - 1);
  while (x >= 0 && x < cover.width && cover.at[cover.Index(x, y)] > 0.5F) x += step;
  return std::max(std::abs(static_cast<float>(x) + 0.5F - axis), 1.0F);
}

namespace {

/// `pose`: as large as the pictures.
Bust DrawWith(const BaseHead& base, const FittedHead& fitted, CameraPose pose, int width,
              int height) {
  // Upright below the fitted head, whose chin may be lower than the built-in one's.
  pose.turn = {};
  const MeshPoint& chin = base.points[point::kChin];
  const glm::vec3 chin_at_rest = chin.On(base.rest.position);
  const float lower = chin_at_rest.y - chin.On(fitted.posed_vertices).y;
  const float highest = chin_at_rest.y + PhotoLook()("bust_above_chin");
  const FloatImage none(width, height);
  Bust bust{none, none, none, {none, none, FloatImage(width, height, 1)}, pose.Project({}).x};
  FloatImage depth(width, height, -1e9F);
  const fsm::HeadTopology& topology = base.head->topology();
  for (const auto& part : topology.parts) {
    const bool cloth = part.material == fsm::Material::kCloth;
    if (!cloth && part.material != fsm::Material::kSkin) continue;
    for (std::uint32_t k = 0; k + 2 < part.index_count; k += 3) {
      const std::uint32_t* t = &topology.indices[part.first_index + k];
      std::array<glm::vec3, 3> q;
      std::array<glm::vec2, 3> p;
      for (std::size_t c = 0; c < 3; ++c) {
        q[c] = base.rest.position[t[c]] - glm::vec3(0, lower, 0);
        p[c] = pose.Project(q[c]) - 0.5F;
      }
      if (std::max({q[0].y, q[1].y, q[2].y}) + lower > highest) continue;
      Rasterize({p[0], p[1], p[2]}, width, height, 0.01F, [&](int x, int y, glm::vec3 w) {
        const glm::vec3 n = Interpolated(base.rest.normal, t, w);
        const float z = w.x * q[0].z + w.y * q[1].z + w.z * q[2].z;
        const std::size_t i = depth.Index(x, y);
        if (n.z <= 0 || z <= depth.at[i]) return;
        depth.at[i] = z;
        bust.cover.at[i] = 1;
        bust.cloth.at[i] = cloth ? 1 : 0;
        bust.open.at[i] = Interpolated(topology.occlusion, t, w);
        for (std::size_t c = 0; c < 3; ++c) bust.normal[c].at[i] = n[static_cast<int>(c)];
      });
    }
  }
  return bust;
}

}  // namespace

Bust DrawBust(const BaseHead& base, const FittedHead& fitted, int width, int height) {
  // Of a small photo a pixel is wide: several samples to each soften the outlines.
  constexpr float kSamplesPerMm = 3;
  const int finer =
      std::clamp(static_cast<int>(std::ceil(kSamplesPerMm / fitted.pose.PixelsPerMm())), 1, 4);
  CameraPose pose = fitted.pose;
  pose.focal *= static_cast<float>(finer);
  pose.centre *= static_cast<float>(finer);
  Bust bust = DrawWith(base, fitted, pose, finer * width, finer * height);
  bust.axis /= static_cast<float>(finer);
  for (FloatImage* image :
       {&bust.cover, &bust.cloth, &bust.open, &bust.normal[0], &bust.normal[1], &bust.normal[2]}) {
    *image = ScaledDown(*image, width, height);
  }
  return bust;
}

}  // namespace facefit
