#include "face_fit/find/face/glasses.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <vector>

#include "face_fit/image/median.h"
#include "face_fit/image/plane.h"
#include "face_fit/image/resample.h"

namespace facefit {
namespace {

constexpr float kInnerCornersMm = 32;  // distance of the inner corners of the eyes, roughly
// Grid of samples in which a bar is searched: columns across the bridge, rows from kTopMm
// (negative: above the eyes) down; and rows of skin above and below that a bar is compared with.
constexpr int kBarColumns = 9, kBarRows = 60;
constexpr float kBarColumnStepMm = 1.25F, kBarRowStepMm = 0.5F, kTopMm = -14;
constexpr std::size_t kBesideRows = 5, kMinBarRows = 4, kMaxBarRows = 18, kBarStepRows = 2;
/// The least brightness, 0..255, that contrast is divided by: in the dark it is noise.
constexpr float kDarkestSkin = 20;
// Rotations and offsets at which a bar is searched; the median counts. A bar shows at all of them,
// a crease only along its line, and a point that is a pixel off must not decide.
constexpr float kRotationsRad[] = {-0.1F, 0, 0.1F}, kBarOffsetsMm[] = {-2, 0, 2};

/// Returns the contrast of a bar across the bridge of the nose to the skin above and below it,
/// divided by the skin's brightness, for one offset to the person's left and one rotation.
float BarAcross(const FoundFace& face, const fsm::Image& photo, float offset_mm,
                float rotation_rad) {
  const glm::vec2 right = face.PixelOf(point::kEyeInnerRight),
                  left = face.PixelOf(point::kEyeInnerLeft), middle = 0.5F * (right + left);
  const float pixels_per_mm = std::max(glm::distance(right, left) / kInnerCornersMm, 1e-3F);
  const glm::vec2 level = (left - right) / (kInnerCornersMm * pixels_per_mm);
  const glm::vec2 across = Rotated(level, rotation_rad), down(-across.y, across.x);
  std::array<std::array<glm::vec3, kBarRows>, kBarColumns> colour{};
  for (std::size_t c = 0; c < kBarColumns; ++c) {
    for (std::size_t r = 0; r < kBarRows; ++r) {
      const float x = offset_mm + kBarColumnStepMm * (static_cast<float>(c) - kBarColumns / 2),
                  y = kTopMm + kBarRowStepMm * static_cast<float>(r);
      colour[c][r] = ColourAt(photo, middle + pixels_per_mm * (x * across + y * down));
    }
  }
  const auto mean = [&colour](std::size_t c, std::size_t from, std::size_t to) {
    glm::vec3 sum(0);
    for (std::size_t r = from; r < to; ++r) sum += colour[c][r];
    return sum / static_cast<float>(to - from);
  };
  float most = 0;
  for (std::size_t width = kMinBarRows; width <= kMaxBarRows; width += kBarStepRows) {
    for (std::size_t top = kBesideRows; top + width + kBesideRows < kBarRows; ++top) {
      std::vector<float> steps;
      for (std::size_t c = 0; c < kBarColumns; ++c) {
        const glm::vec3 above = mean(c, top - kBesideRows, top);
        const glm::vec3 bar = mean(c, top, top + width);
        const glm::vec3 below = mean(c, top + width, top + width + kBesideRows);
        // The bar must differ from both sides in the same direction.
        const glm::vec3 a = bar - above, b = bar - below;
        const float least = glm::dot(a, b) > 0 ? std::min(glm::length(a), glm::length(b)) : 0.0F;
        steps.push_back(least / std::max(glm::length(0.5F * (above + below)), kDarkestSkin));
      }
      // All columns but one must show the bar.
      std::ranges::nth_element(steps, steps.begin() + 1);
      most = std::max(most, steps[1]);
    }
  }
  return most;
}

}  // namespace

bool WearsGlasses(const FoundFace& face, const fsm::Image& photo) {
  std::vector<float> contrasts;
  for (const float rotation_rad : kRotationsRad) {
    for (const float offset_mm : kBarOffsetsMm) {
      contrasts.push_back(BarAcross(face, photo, offset_mm, rotation_rad));
    }
  }
  constexpr float kGlassesContrast = 0.11F;
  return Median(std::move(contrasts)) > kGlassesContrast;
}

}  // namespace facefit
