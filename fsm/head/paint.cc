#include "fsm/head/paint.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "fsm/base/smooth_step.h"

namespace fsm {

SkinPainter::SkinPainter(const Identity& identity, const EyeAnatomy& eye)
    : features_(*identity.features), eye_(eye), palette_(identity.palette) {
  const auto add = [this](const auto& row) {
    spots_.push_back({row.middle, row.half_size, row.blush, row.shade});
  };
  const auto& spot = features_.spot;
  add(spot.cheeks);
  add(spot.nose_tip);
  add(spot.chin);
  add(spot.nose_groove);
  add(spot.nose_side);
  add(spot.under_nose);
  add(spot.under_eye);
  add(spot.under_lip);
  add(spot.mouth_corners);
}

void SkinPainter::AddSpots(glm::vec2 at, PaintedSkin& paint) const {
  for (const Spot& spot : spots_) {
    const glm::vec2 d = (at - spot.centre) / spot.half_size;
    const float weight = Gaussian(glm::dot(d, d));
    paint.albedo = glm::mix(paint.albedo, palette_.blush, spot.blush * weight);
    paint.openness *= 1 - spot.shade * weight;
  }
}

float SkinPainter::Beard(glm::vec2 at, float z) const {
  if (palette_.beard <= 0) return 0;
  const auto& place = features_.beard_place;
  const float jaw_line = features_.beard_line.At(place.line_over.Ramp(at.x));
  const float low = (jaw_line + place.below).Ramp(at.y) * place.throat.Ramp(at.y);
  const float front = place.front.Ramp(z);
  // Only beside the mouth does the nose end it.
  const float under_nose =
      glm::mix(place.under_nose.Ramp(at.y), 1.0f, place.beside_nose.Ramp(at.x));
  const glm::vec2 offset =
      (at - features_.beard_thin_cheek.middle) / features_.beard_thin_cheek.half_size;
  const float cheek = 1 - features_.beard_thin_cheek.part * Gaussian(glm::dot(offset, offset));
  return palette_.beard * low * front * under_nose * cheek;
}

/// The upper lid is a little darker and warmer, most in its fold and at its lashes.
void SkinPainter::AddLid(glm::vec2 at, PaintedSkin& paint) const {
  const auto& place = features_.lid_place;
  const float ends =
      (eye_.inner_x() + place.inner).Ramp(at.x) * (eye_.outer_x() + place.outer).Ramp(at.x);
  if (ends <= 0) return;
  const float above = at.y - eye_.UpperY(at.x);
  const float offset = (above - place.fold) / place.fold_width;
  const float fold = Gaussian(offset * offset) * ends;
  const float lid = ends * place.above.Ramp(above) * place.margin.Ramp(above);
  paint.albedo =
      glm::mix(paint.albedo, palette_.skin * features_.lid_colour, features_.lid_tint * lid);
  paint.openness *= 1 - features_.lid_fold_shade * fold;
}

PaintedSkin SkinPainter::At(glm::vec3 p) const {
  const glm::vec2 half(std::abs(p.x), p.y);
  PaintedSkin paint{palette_.skin, 1.0f};
  const auto& throat = features_.throat_place;
  const bool front = p.z > features_.front_z;
  if (front) AddSpots(half, paint);
  paint.albedo *= glm::mix(glm::vec3(1), features_.beard_colour, Beard(half, p.z));
  // Darkens the skin under the jaw, down to the throat.
  const float under = throat.begins.Ramp(p.y) * throat.ends.Ramp(p.y) *
                      throat.behind.Ramp(p.z + throat.slope * (p.y - throat.slope_y));
  paint.openness *= 1 - features_.throat_shade * under * throat.front.Ramp(p.z);
  if (front) AddLid(half, paint);
  return paint;
}

}  // namespace fsm
