#include "face_fit/bake/openings.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/find/network/network_points.h"
#include "face_fit/picture/plane.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {

Openings::Openings(const FoundFace& face, float pixels_per_mm, bool lips_apart) : face_(face) {
  const fsm::NumberTable& look = PhotoLook();
  // The dark line of the lashes stays on the rims of the lids.
  const float lash = look("lash_rim") * pixels_per_mm;
  for (const fsm::Side side : fsm::kSides) {
    const auto outline = EyeOutline(side);
    openings_.push_back({{outline.begin(), outline.end()}, -lash, -lash});
  }
  if (lips_apart) {
    std::vector<PointIndex> mouth(point::kUpperInnerLip.begin(), point::kUpperInnerLip.end());
    mouth.insert(mouth.end(), point::kLowerInnerLip.rbegin(), point::kLowerInnerLip.rend());
    // Teeth shine through the blurred edge of the lips, in a small photo over more of them.
    const glm::vec2 rim = glm::max(look.Pair("mouth_rim") * pixels_per_mm, glm::vec2(0.8F, 1));
    openings_.push_back({mouth, rim.x, rim.x + rim.y});
  }
  for (Opening& opening : openings_) {
    Box2 box;
    for (const PointIndex i : opening.outline) box.Add(face.At(i));
    opening.middle = box.Middle();
    opening.radius = 0.5F * glm::distance(box.low, box.high) + std::max(opening.all, 0.0F);
  }
}

float Openings::SkinWeight(glm::vec2 pixel) const {
  float part = 1;
  for (const Opening& opening : openings_) {
    if (glm::distance(pixel, opening.middle) >= opening.radius) continue;
    const float outside = SignedDistance(face_, opening.outline, pixel);
    const float here = opening.all > opening.none
                           ? glm::smoothstep(opening.none, opening.all, outside)
                           : static_cast<float>(outside >= opening.none);
    part = std::min(part, here);
  }
  return part;
}

float SignedDistance(const FoundFace& face, std::span<const PointIndex> outline, glm::vec2 pixel) {
  bool inside = false;
  float nearest = 1e9F;
  const auto at = [&](std::size_t k) { return face.At(outline[k]); };
  for (std::size_t k = 0, j = outline.size() - 1; k < outline.size(); j = k++) {
    const glm::vec2 a = at(k), b = at(j);
    nearest = std::min(nearest, DistanceToSegment(pixel, a, b));
    // The ray to the right crosses the edge (even-odd rule).
    if ((a.y > pixel.y) == (b.y > pixel.y)) continue;
    if (pixel.x < (b.x - a.x) * (pixel.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
  }
  return inside ? -nearest : nearest;
}

}  // namespace facefit
