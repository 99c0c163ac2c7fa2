#include "fsm/head/paint.h"

#include <cmath>
#include <glm/common.hpp>

#include "fsm/base/smooth_step.h"

namespace fsm {

SkinPainter::SkinPainter(const Identity& identity, const EyeAnatomy& eye)
    : features_(identity.UsedFeatures()), eye_(eye), palette_(identity.palette) {
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
    const glm::vec2 d = (at - spot.at) / spot.size;
    const float weight = std::exp(-0.5f * (d.x * d.x + d.y * d.y));
    paint.albedo = glm::mix(paint.albedo, palette_.blush, spot.blush * weight);
    paint.openness *= 1 - spot.shade * weight;
  }
}

float SkinPainter::Beard(glm::vec2 at, float z) const {
  if (palette_.beard <= 0) return 0;
  const float jaw_line = Lerp(features_.beard_line, SmoothStep(30, 62, at.x));
  const float low = SmoothStep(jaw_line + 6, jaw_line - 22, at.y) * SmoothStep(-128, -100, at.y);
  const float front = SmoothStep(-12, 8, z);
  // Only beside the mouth does the nose end it.
  const float under_nose = glm::mix(SmoothStep(-23, -27, at.y), 1.0f, SmoothStep(20, 34, at.x));
  const glm::vec2 off =
      (at - features_.beard_thin_cheek.middle) / features_.beard_thin_cheek.half_size;
  const float cheek =
      1 - features_.beard_thin_cheek.part * std::exp(-0.5f * (off.x * off.x + off.y * off.y));
  return palette_.beard * low * front * under_nose * cheek;
}

/// The upper lid is a little darker and warmer, most in its fold and at its lashes.
void SkinPainter::AddLid(glm::vec2 at, PaintedSkin& paint) const {
  if (at.x <= eye_.inner_x() - 4 || at.x >= eye_.outer_x() + 5) return;
  const float above = at.y - eye_.UpperY(at.x);
  const float ends = SmoothStep(eye_.inner_x() - 4, eye_.inner_x() + 3, at.x) *
                     SmoothStep(eye_.outer_x() + 5, eye_.outer_x() - 3, at.x);
  const float fold = std::exp(-0.5f * (above - 4.2f) * (above - 4.2f) / 1.2f) * ends;
  const float lid = ends * SmoothStep(10, 2, above) * SmoothStep(-1, 0, above);
  paint.albedo =
      glm::mix(paint.albedo, palette_.skin * features_.lid_colour, features_.lid_tint * lid);
  paint.openness *= 1 - features_.lid_fold_shade * fold;
}

PaintedSkin SkinPainter::At(glm::vec3 p) const {
  const glm::vec2 half(std::abs(p.x), p.y);
  PaintedSkin paint{palette_.skin, 1.0f};
  const bool front = p.z > 40;
  if (front) AddSpots(half, paint);
  paint.albedo *= glm::mix(glm::vec3(1), features_.beard_colour, Beard(half, p.z));
  // Darkens the skin under the jaw, down to the throat.
  const float under = SmoothStep(-80, -92, p.y) * SmoothStep(-150, -108, p.y) *
                      SmoothStep(64, 52, p.z + 0.4f * (p.y + 88));
  paint.openness *= 1 - features_.throat_shade * under * SmoothStep(-30, 10, p.z);
  if (front) AddLid(half, paint);
  return paint;
}

}  // namespace fsm
