#include "fsm/render/painted_strokes.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace fsm {
namespace {

/// Returns the distance of a point from a segment, and the position along the segment, 0..1.
glm::vec2 Beside(glm::vec2 p, glm::vec2 from, glm::vec2 to) {
  const glm::vec2 line = to - from;
  const float t =
      std::clamp(glm::dot(p - from, line) / std::max(glm::dot(line, line), 1e-6f), 0.0f, 1.0f);
  return {glm::length(p - from - t * line), t};
}

void PaintStroke(const SkinStroke& stroke, SkinTexture& out) {
  const auto texels = static_cast<float>(SkinTexture::kSide);
  const std::array points = {texels * stroke.root, texels * stroke.middle, texels * stroke.tip};
  const auto [left, right] = std::minmax({points[0].x, points[1].x, points[2].x});
  const auto [low, high] = std::minmax({points[0].y, points[1].y, points[2].y});
  const float half = 0.5f * stroke.width_mm * SkinTexture::kTexelsPerMm;
  const auto first = [half](float v) { return std::max(static_cast<int>(v - half - 1), 0); };
  const auto last = [half](float v) {
    return std::min(static_cast<int>(v + half + 1), SkinTexture::kSide - 1);
  };
  for (int y = first(low); y <= last(high); ++y) {
    for (int x = first(left); x <= last(right); ++x) {
      const glm::vec2 p(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
      const glm::vec2 lower = Beside(p, points[0], points[1]);
      const glm::vec2 upper = Beside(p, points[1], points[2]);
      const bool root_half = lower.x <= upper.x;
      const float along = root_half ? 0.5f * lower.y : 0.5f + 0.5f * upper.y;
      const float wide = half * (1 - 0.8f * along * along);
      // A stroke thinner than a texel covers part of it.
      const float cover =
          std::clamp(wide + 0.5f - (root_half ? lower.x : upper.x), 0.0f, std::min(1.0f, 2 * wide));
      if (cover <= 0) continue;
      std::uint8_t* tint = &out.tint.rgba[4 * out.tint.Index(x, y)];
      for (int k = 0; k < 4; ++k) {
        // Overlapping strokes do not darken each other; all are duller than skin.
        const float own = 128 * (k < 3 ? std::min(stroke.tint[k], 1.0f) : 0.4f);
        const auto skin = static_cast<float>(tint[k]);
        tint[k] = static_cast<std::uint8_t>(skin + cover * (std::min(own, skin) - skin) + 0.5f);
      }
    }
  }
}

}  // namespace

void PaintStrokes(std::span<const SkinStroke> strokes, SkinTexture& out) {
  for (const SkinStroke& stroke : strokes) PaintStroke(stroke, out);
}

}  // namespace fsm
