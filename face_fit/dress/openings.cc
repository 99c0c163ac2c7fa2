#include "face_fit/dress/openings.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/dress/dress.h"

namespace facefit {

Openings::Openings(const FoundFace& face, float pixels_per_mm, bool lips_apart) : face_(face) {
  // The dark line of the lashes stays on the rims of the lids.
  const float lash = 0.9F * pixels_per_mm;
  for (const int side : {0, 1}) {
    const auto outline = EyeOutline(side);
    openings_.push_back({{outline.begin(), outline.end()}, -lash, -lash});
  }
  if (lips_apart) {
    std::vector<int> mouth(UpperInnerLip().begin(), UpperInnerLip().end());
    mouth.insert(mouth.end(), LowerInnerLip().rbegin(), LowerInnerLip().rend());
    // Teeth shine through the blurred edge of the lips, in a small photo over more of them.
    const float rim = std::max(0.7F * pixels_per_mm, 0.8F);
    openings_.push_back({mouth, rim, rim + std::max(0.8F * pixels_per_mm, 1.0F)});
  }
  for (Opening& opening : openings_) {
    glm::vec2 low(1e9F), high(-1e9F);
    for (const int i : opening.outline) {
      low = glm::min(low, glm::vec2(face.points[static_cast<std::size_t>(i)]));
      high = glm::max(high, glm::vec2(face.points[static_cast<std::size_t>(i)]));
    }
    opening.middle = 0.5F * (low + high);
    opening.radius = 0.5F * glm::distance(low, high) + std::max(opening.all, 0.0F);
  }
}

float Openings::Skin(glm::vec2 pixel) const {
  float part = 1;
  for (const Opening& opening : openings_) {
    if (glm::distance(pixel, opening.middle) >= opening.radius) continue;
    const float outside = Outside(face_, opening.outline, pixel);
    const float here = opening.all > opening.none
                           ? glm::smoothstep(opening.none, opening.all, outside)
                           : static_cast<float>(outside >= opening.none);
    part = std::min(part, here);
  }
  return part;
}

}  // namespace facefit
