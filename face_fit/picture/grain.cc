#include "face_fit/picture/grain.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/pixels.h"
#include "fsm/base/smooth_step.h"

namespace facefit {
namespace {

constexpr float kKnown = 0.95F;

glm::ivec2 PixelOf(const FloatImage& field, std::size_t i) {
  const auto width = static_cast<std::size_t>(field.width);
  return {static_cast<int>(i % width), static_cast<int>(i / width)};
}

}  // namespace

void AddGrain(const Mask& weight, const Mask& where, int reach, fsm::Image& image) {
  if (std::ranges::max(weight.values) < kKnown) return;
  const auto nearest = NearestAbove(weight, kKnown);
  const float farthest = 8 * static_cast<float>(reach);
  struct Transfer {
    std::size_t to, from;
    float amount;
  };
  std::vector<Transfer> transfers;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    if (weight[i] >= kKnown || where[i] <= 0) continue;
    const glm::ivec2 pixel = PixelOf(weight, i), edge = PixelOf(weight, nearest[i]);
    const glm::ivec2 beyond = 2 * edge - pixel;
    if (beyond.x < 0 || beyond.y < 0 || beyond.x >= weight.width || beyond.y >= weight.height) {
      continue;
    }
    const std::size_t from = weight.Index(beyond.x, beyond.y);
    const float distance_px = glm::length(glm::vec2(edge - pixel));
    const float amount = where[i] * weight[from] * (1 - weight[i]) *
                         fsm::SmoothStep(farthest, 0.5F * farthest, distance_px);
    if (amount > 0) transfers.push_back({i, from, amount});
  }
  const VectorImage colours = Colours(image), even = Blurred(colours, reach);
  for (const auto& [to, from, amount] : transfers) {
    SetRgb(image, to, colours[to] + amount * (colours[from] - even[from]));
  }
}

}  // namespace facefit
