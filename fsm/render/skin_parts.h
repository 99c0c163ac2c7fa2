#pragma once

#include <algorithm>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "fsm/render/skin_map.h"
#include "fsm/render/skin_texture.h"

namespace fsm {

/// About exp(-(x / width)^2), and nothing beyond two widths.
inline float Bell(float x, float width) {
  const float t = std::max(1 - x * x / (4 * width * width), 0.0F);
  return t * t * t * t;
}

/// 0 up to `from`, 1 from `to` on (which may be less), smooth between.
inline float Smooth(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

/// What changes slowly over the skin, one for each cell of a SkinMap.
struct SkinRegion {
  glm::vec4 tint{1.0F};  ///< factors on colour and on highlights
  float pores = 0;       ///< how strongly they show, 0..1
  float cracks = 0;      ///< the same of the lines of lips
};
std::vector<SkinRegion> PaintRegions(const SkinMap& map, const FaceMarks& marks);

/// How high above the skin a place lies when all creases are at their deepest, millimetres.
float CreaseHeight(const glm::vec3& place, const FaceMarks& marks);
/// False where no crease is within a few millimetres.
bool MayCrease(const glm::vec3& place, const FaceMarks& marks);

/// Draws hairs into the tint, each a bent line that ends in a point.
void PaintHairs(std::span<const SkinHair> hairs, SkinTexture& out);

}  // namespace fsm
