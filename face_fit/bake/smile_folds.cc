#include "face_fit/bake/smile_folds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

float ToLine(std::span<const glm::vec2> line, glm::vec2 p) {
  float nearest = 1e9F;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const glm::vec2 way = line[k] - line[k - 1];
    const float part = glm::dot(p - line[k - 1], way) / std::max(glm::dot(way, way), 1e-6F);
    nearest = std::min(nearest, glm::distance(p, line[k - 1] + glm::clamp(part, 0.0F, 1.0F) * way));
  }
  return nearest;
}

/// How folds are filled.
struct Filling {
  float smile;  // 0..1
  float pixels_per_mm;
  float reach;  // millimetres beside the fold
  int valley;   // half its width, pixels
};

/// `smooth` becomes how much of each pixel was filled, 0..1.
void FillFold(std::span<const glm::vec2> line, const Filling& filling, fsm::Image& photo,
              FloatImage& smooth) {
  const auto& [smile, pixels_per_mm, reach, valley] = filling;
  Box2 box;
  for (const glm::vec2 at : line) box.Add(at);
  const float margin = reach * pixels_per_mm + 2 * static_cast<float>(valley);
  const glm::ivec2 first = glm::max(glm::ivec2(box.low - margin), 0);
  const glm::ivec2 last = glm::min(glm::ivec2(box.high + margin) + 1, {photo.width, photo.height});
  if (last.x <= first.x || last.y <= first.y) return;
  const glm::ivec2 size = last - first;
  const auto value = [&](int x, int y, std::size_t channel) -> std::uint8_t& {
    return photo.rgba[4 * photo.Index(first.x + x, first.y + y) + channel];
  };
  FloatImage part(size.x, size.y);
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const float off = ToLine(line, glm::vec2(first + glm::ivec2(x, y)) + 0.5F) / pixels_per_mm;
      part.at[part.Index(x, y)] = smile * glm::smoothstep(reach, 0.5F * reach, off);
    }
  }
  // Each colour for itself: folds are redder than the skin beside them.
  for (std::size_t channel = 0; channel < 3; ++channel) {
    FloatImage light(size.x, size.y);
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) light.at[light.Index(x, y)] = value(x, y, channel);
    }
    const FloatImage filled = Blurred(Closed(light, valley), std::max(valley / 2, 1));
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const std::size_t i = light.Index(x, y);
        const float lit = std::max(filled.at[i], light.at[i]);
        float& lost = smooth.at[smooth.Index(first.x + x, first.y + y)];
        if (lit > light.at[i]) lost = std::max(lost, part.at[i]);
        value(x, y, channel) = Byte(glm::mix(light.at[i], lit, part.at[i]));
      }
    }
  }
}

}  // namespace

FloatImage FillSmileFolds(const FoundFace& face, float smile, float pixels_per_mm,
                          fsm::Image& photo) {
  FloatImage smooth(photo.width, photo.height);
  const int valley = static_cast<int>(std::lround(PhotoLook()("fold_half_width") * pixels_per_mm));
  if (smile <= 0 || valley < 1) return smooth;
  for (const fsm::Side side : fsm::kSides) {
    std::vector<glm::vec2> line;
    for (const PointIndex i : point::kSmileFold[side]) line.push_back(face.At(i));
    FillFold(line, {smile, pixels_per_mm, PhotoLook()("fold_reach"), valley}, photo, smooth);
  }
  return smooth;
}

}  // namespace facefit
