#include "fsm/render/skin_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/vec2.hpp>

namespace fsm {

SkinMap::SkinMap(const HeadSurface& surface, const HeadVertices& rest) {
  constexpr auto count = static_cast<std::size_t>(kCells) * kCells;
  kind.assign(count, kNone);
  position.resize(count);
  outward_.assign(count, -1.0f);
  for (const auto& part : surface.parts) {
    if (part.material != Material::kSkin && part.material != Material::kLip) continue;
    const Kind what = part.material == Material::kSkin ? kSkin : kLip;
    for (std::uint32_t k = 0; k + 2 < part.index_count; k += 3) {
      Fill(surface, rest, &surface.indices[part.first_index + k], what);
    }
  }
}

void SkinMap::Fill(const HeadSurface& surface, const HeadVertices& rest,
                   const std::uint32_t* corners, Kind what) {
  std::array<glm::vec2, 3> uv;
  std::array<glm::vec3, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    uv[k] = surface.uv[corners[k]] * static_cast<float>(kCells) - 0.5f;
    p[k] = rest.position[corners[k]];
  }
  const glm::vec2 e1 = uv[1] - uv[0];
  const glm::vec2 e2 = uv[2] - uv[0];
  const float area = e1.x * e2.y - e1.y * e2.x;
  const auto [left, right] = std::minmax({uv[0].x, uv[1].x, uv[2].x});
  const auto [low, high] = std::minmax({uv[0].y, uv[1].y, uv[2].y});
  // A triangle across the seam at the back would smear over the whole map.
  if (std::abs(area) < 1e-6f || right - left > static_cast<float>(kCells) / 2) return;
  const int x0 = std::max(static_cast<int>(std::ceil(left)), 0);
  const int x1 = std::min(static_cast<int>(std::floor(right)), kCells - 1);
  const int y0 = std::max(static_cast<int>(std::ceil(low)), 0);
  const int y1 = std::min(static_cast<int>(std::floor(high)), kCells - 1);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const glm::vec2 d = glm::vec2(static_cast<float>(x), static_cast<float>(y)) - uv[0];
      const float b = (d.x * e2.y - d.y * e2.x) / area;
      const float c = (e1.x * d.y - e1.y * d.x) / area;
      // The test reaches a little beyond the edges, so that no texel between triangles is missed.
      if (b < -0.02f || c < -0.02f || b + c > 1.02f) continue;
      const glm::vec3 at = p[0] + b * (p[1] - p[0]) + c * (p[2] - p[0]);
      const float outward = std::hypot(at.x, at.z);
      const auto i = Index(x, y);
      if (outward <= outward_[i]) continue;
      outward_[i] = outward;
      kind[i] = what;
      position[i] = at;
    }
  }
}

SkinMap::Kind SkinMap::KindAt(float u, float v) const {
  const int x = static_cast<int>(std::floor(u * kCells));
  const int y = static_cast<int>(std::floor(v * kCells));
  if (x < 0 || y < 0 || x >= kCells || y >= kCells) return kNone;
  return kind[Index(x, y)];
}

glm::vec3 SkinMap::PositionAt(float u, float v) const {
  const float x = std::clamp(u * kCells - 0.5f, 0.0f, kCells - 1.001f);
  const float y = std::clamp(v * kCells - 0.5f, 0.0f, kCells - 1.001f);
  const int cx = static_cast<int>(x);
  const int cy = static_cast<int>(y);
  const float s = x - static_cast<float>(cx);
  const float t = y - static_cast<float>(cy);
  const auto i = Index(cx, cy);
  // Beside a hole only the nearest cell is used.
  if (kind[i] == kNone || kind[i + 1] == kNone || kind[i + kCells] == kNone ||
      kind[i + kCells + 1] == kNone) {
    return position[Index(static_cast<int>(x + 0.5f), static_cast<int>(y + 0.5f))];
  }
  return (position[i] * (1 - s) + position[i + 1] * s) * (1 - t) +
         (position[i + kCells] * (1 - s) + position[i + kCells + 1] * s) * t;
}

}  // namespace fsm
