#include "face_fit/bake/openings.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_fit/find/network/network_points.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/plane.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Least value of either width round the mouth: the blur of a small photo's pixels.
constexpr glm::vec2 kMinRimPx{0.8F, 1};

}  // namespace

PhotoOpenings::PhotoOpenings(const FoundFace& face, float pixels_per_mm) {
  const PhotoLookNumbers& look = PhotoLook();
  // The dark line of the lashes stays on the rims of the lids.
  const float lash = look.opening.lashes_mm * pixels_per_mm;
  for (const fsm::Side side : fsm::kSides) {
    openings_.push_back({face.Line(point::kEyeOutline[side]), -lash, -lash});
  }
  if (LipsApart(face)) {
    std::vector<PointIndex> mouth = WithCorners(point::kUpperInnerLip, point::kInnerMouthCorners);
    mouth.insert(mouth.end(), point::kLowerInnerLip.rbegin(), point::kLowerInnerLip.rend());
    // The blurred edge of the lips mixes with teeth, more so in a small photo.
    const glm::vec2 rim = glm::max(pixels_per_mm * glm::vec2(look.opening.no_skin_round_mouth_mm,
                                                             look.opening.fades_round_mouth_mm),
                                   kMinRimPx);
    openings_.push_back({face.Line(mouth), rim.x, rim.x + rim.y});
  }
  for (Opening& opening : openings_) {
    Box2 box;
    for (const glm::vec2 p : opening.outline) box.Add(p);
    opening.middle = box.Middle();
    opening.radius = 0.5F * glm::distance(box.low, box.high) + std::max(opening.all_skin_px, 0.0F);
  }
}

float PhotoOpenings::SkinShare(glm::vec2 pixel) const {
  float skin = 1;
  for (const Opening& opening : openings_) {
    if (glm::distance(pixel, opening.middle) >= opening.radius) continue;
    const float outside = SignedDistance(opening.outline, pixel);
    const float outside_this =
        opening.all_skin_px > opening.no_skin_px
            ? fsm::SmoothStep(opening.no_skin_px, opening.all_skin_px, outside)
            : static_cast<float>(outside >= opening.no_skin_px);
    skin = std::min(skin, outside_this);
  }
  return skin;
}

}  // namespace facefit
