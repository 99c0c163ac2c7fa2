#include "face_fit/find/face/glasses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "face_fit/picture/pixels.h"
#include "face_fit/picture/resample.h"

namespace facefit {
namespace {

/// How much a bar across the bridge of the nose stands out, as BridgeContrast, looked for `aside`
/// millimetres to the left of the middle and turned by `turn` radians.
float BarAcross(const FoundFace& face, const fsm::Image& photo, float aside, float turn) {
  // Between the inner corners of the eyes, which lie some 32 mm apart.
  const glm::vec2 right = face.At(point::kEyeInnerRight), left = face.At(point::kEyeInnerLeft),
                  middle = 0.5F * (right + left);
  const float pixels_per_mm = std::max(glm::distance(right, left) / 32, 1e-3F);
  const glm::vec2 level = (left - right) / (32 * pixels_per_mm);
  const glm::vec2 across = std::cos(turn) * level + std::sin(turn) * glm::vec2(-level.y, level.x);
  const glm::vec2 down(-across.y, across.x);
  constexpr int kColumns = 9, kRows = 60;  // 1.25 mm apart; half millimetres from above the brows
  constexpr float kTop = -14;
  std::array<std::array<glm::vec3, kRows>, kColumns> colour{};
  for (std::size_t c = 0; c < kColumns; ++c) {
    for (std::size_t r = 0; r < kRows; ++r) {
      const float x = aside + 1.25F * (static_cast<float>(c) - 4),
                  y = kTop + 0.5F * static_cast<float>(r);
      colour[c][r] = ColourAt(photo, middle + pixels_per_mm * (x * across + y * down));
    }
  }
  const auto mean = [&colour](std::size_t c, std::size_t from, std::size_t to) {
    glm::vec3 sum(0);
    for (std::size_t r = from; r < to; ++r) sum += colour[c][r];
    return sum / static_cast<float>(to - from);
  };
  float most = 0;
  constexpr std::size_t kBeside = 5;  // rows
  for (std::size_t width = 4; width <= 18; width += 2) {
    for (std::size_t top = kBeside; top + width + kBeside < kRows; ++top) {
      std::vector<float> steps;
      for (std::size_t c = 0; c < kColumns; ++c) {
        const glm::vec3 above = mean(c, top - kBeside, top);
        const glm::vec3 bar = mean(c, top, top + width);
        const glm::vec3 below = mean(c, top + width, top + width + kBeside);
        // On either side the bar differs in the same way.
        const glm::vec3 a = bar - above, b = bar - below;
        const float least = glm::dot(a, b) > 0 ? std::min(glm::length(a), glm::length(b)) : 0.0F;
        steps.push_back(least / std::max(glm::length(0.5F * (above + below)), 20.0F));
      }
      // Nearly all the way across.
      std::ranges::nth_element(steps, steps.begin() + 1);
      most = std::max(most, steps[1]);
    }
  }
  return most;
}

}  // namespace

float BridgeContrast(const FoundFace& face, const fsm::Image& photo) {
  // A bar is seen whichever way one looks across it, a crease only along its line; and a point that
  // lies a pixel elsewhere must not decide.
  std::vector<float> seen;
  for (const float turn : {-0.1F, 0.0F, 0.1F}) {
    for (const float aside : {-2.0F, 0.0F, 2.0F}) {
      seen.push_back(BarAcross(face, photo, aside, turn));
    }
  }
  return Median(std::move(seen));
}

}  // namespace facefit
