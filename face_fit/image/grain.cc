#include "face_fit/image/grain.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"
#include "fsm/base/smooth_step.h"

namespace facefit {
namespace {

constexpr float kSurelyKnown = 0.95F;

glm::ivec2 PixelAtIndex(const Mask& image, std::size_t i) {
  const auto width = static_cast<std::size_t>(image.width);
  return {static_cast<int>(i % width), static_cast<int>(i / width)};
}

}  // namespace

void AddGrain(const Mask& known, const Mask& amount, int reach, fsm::Image& image) {
  if (std::ranges::max(known.values) < kSurelyKnown) return;
  const auto nearest = NearestAbove(known, kSurelyKnown);
  const float farthest = 8 * static_cast<float>(reach);
  const VectorImage colours = Colours(image), even = Blurred(colours, reach);
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] >= kSurelyKnown || amount[i] <= 0) continue;
    const glm::ivec2 pixel = PixelAtIndex(known, i), edge = PixelAtIndex(known, nearest[i]);
    const glm::ivec2 beyond = 2 * edge - pixel;
    if (beyond.x < 0 || beyond.y < 0 || beyond.x >= known.width || beyond.y >= known.height) {
      continue;
    }
    const std::size_t from = known.Index(beyond.x, beyond.y);
    const float distance_px = glm::length(glm::vec2(edge - pixel));
    const float share = amount[i] * known[from] * (1 - known[i]) *
                        fsm::SmoothStep(farthest, 0.5F * farthest, distance_px);
    if (share > 0) SetRgb(image, i, colours[i] + share * (colours[from] - even[from]));
  }
}

void AddGrainToFigure(const Mask& known, Mask amount, float pixels_per_mm, fsm::Image& image) {
  const auto& look = PhotoLook().grain;
  for (float& v : amount.values) v *= look.pixels_per_mm.Ramp(pixels_per_mm);
  AddGrain(known, amount, MmToPixels(look.coarsest_on_figure_mm, pixels_per_mm, 2), image);
}

}  // namespace facefit
