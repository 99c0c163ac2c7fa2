#include "face_fit/dress/folds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "face_fit/dress/field.h"

namespace facefit {
namespace {

constexpr float kValley = 5;  // half the width of what is filled, millimetres
constexpr float kReach = 9;   // from the line of the fold, millimetres

// Along the fold, from the wing of the nose to beside the chin; points of the network.
constexpr std::array<std::array<std::size_t, 5>, 2> kFolds = {
    {{129, 203, 206, 216, 212}, {358, 423, 426, 436, 432}}};

/// The largest or smallest of the values up to `reach` to the sides, along rows and then columns.
template <typename Pick>
FloatImage Extreme(const FloatImage& field, int reach, Pick pick) {
  FloatImage rows = field, out = field;
  for (int y = 0; y < field.height; ++y) {
    for (int x = 0; x < field.width; ++x) {
      float best = field.at[field.Index(x, y)];
      for (int k = std::max(x - reach, 0); k <= std::min(x + reach, field.width - 1); ++k) {
        best = pick(best, field.at[field.Index(k, y)]);
      }
      rows.at[field.Index(x, y)] = best;
    }
  }
  for (int y = 0; y < field.height; ++y) {
    for (int x = 0; x < field.width; ++x) {
      float best = rows.at[field.Index(x, y)];
      for (int k = std::max(y - reach, 0); k <= std::min(y + reach, field.height - 1); ++k) {
        best = pick(best, rows.at[field.Index(x, k)]);
      }
      out.at[field.Index(x, y)] = best;
    }
  }
  return out;
}

float ToLine(std::span<const glm::vec2> line, glm::vec2 p) {
  float nearest = 1e9F;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const glm::vec2 way = line[k] - line[k - 1];
    const float part = glm::dot(p - line[k - 1], way) / std::max(glm::dot(way, way), 1e-6F);
    nearest = std::min(nearest, glm::distance(p, line[k - 1] + glm::clamp(part, 0.0F, 1.0F) * way));
  }
  return nearest;
}

}  // namespace

FloatImage FillSmileFolds(const FoundFace& face, float smile, float pixels_per_mm,
                          fsm::Image& photo) {
  FloatImage smooth(photo.width, photo.height);
  if (smile <= 0) return smooth;
  const int valley = static_cast<int>(std::lround(kValley * pixels_per_mm));
  if (valley < 1) return smooth;
  for (const auto& fold : kFolds) {
    std::array<glm::vec2, 5> line;
    glm::vec2 low(1e9F), high(-1e9F);
    for (std::size_t k = 0; k < fold.size(); ++k) {
      line[k] = glm::vec2(face.points[fold[k]]);
      low = glm::min(low, line[k]);
      high = glm::max(high, line[k]);
    }
    const float margin = kReach * pixels_per_mm + 2 * static_cast<float>(valley);
    const glm::ivec2 first = glm::max(glm::ivec2(low - margin), 0);
    const glm::ivec2 last = glm::min(glm::ivec2(high + margin) + 1, {photo.width, photo.height});
    if (last.x <= first.x || last.y <= first.y) continue;
    const glm::ivec2 size = last - first;
    const auto value = [&](int x, int y, std::size_t channel) -> std::uint8_t& {
      return photo
          .rgba[4 * (static_cast<std::size_t>(first.y + y) * static_cast<std::size_t>(photo.width) +
                     static_cast<std::size_t>(first.x + x)) +
                channel];
    };
    FloatImage part(size.x, size.y);
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const float off = ToLine(line, glm::vec2(first + glm::ivec2(x, y)) + 0.5F) / pixels_per_mm;
        part.at[part.Index(x, y)] = smile * glm::smoothstep(kReach, 0.5F * kReach, off);
      }
    }
    // Each colour for itself: folds are redder than the skin beside them.
    for (std::size_t channel = 0; channel < 3; ++channel) {
      FloatImage light(size.x, size.y);
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) light.at[light.Index(x, y)] = value(x, y, channel);
      }
      // A closing (Serra 1982): the dark that no square of that size fits into is gone.
      const FloatImage filled =
          Blurred(Extreme(Extreme(light, valley, [](float a, float b) { return std::max(a, b); }),
                          valley, [](float a, float b) { return std::min(a, b); }),
                  std::max(valley / 2, 1));
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          const std::size_t i = light.Index(x, y);
          const float lit = std::max(filled.at[i], light.at[i]);
          float& lost = smooth.at[smooth.Index(first.x + x, first.y + y)];
          if (lit > light.at[i]) lost = std::max(lost, part.at[i]);
          value(x, y, channel) =
              static_cast<std::uint8_t>(glm::mix(light.at[i], lit, part.at[i]) + 0.5F);
        }
      }
    }
  }
  return smooth;
}

}  // namespace facefit
