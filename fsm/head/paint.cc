#include "fsm/head/paint.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

namespace fsm {
namespace {

/// A soft spot of paint on the face; `strength` mixes towards a colour, `shade` takes off openness.
struct Spot {
  glm::vec2 at, size;
  glm::vec3 Palette::*colour;
  float strength, shade;
};

// Where blood and shadow sit; places on the base identity's face, millimetres.
const std::array kSpots = {
    Spot{{34, -9}, {15, 10}, &Palette::blush, 0.22f, 0},             // cheeks
    Spot{{0, -11}, {8, 7}, &Palette::blush, 0.20f, 0},               // tip of the nose
    Spot{{0, -76}, {12, 8}, &Palette::blush, 0.12f, 0},              // chin
    Spot{{17.2f, -15}, {2.2f, 6}, &Palette::blush, 0.25f, 0.14f},    // groove beside the wing
    Spot{{0, -24.5f}, {10, 2.2f}, &Palette::skin, 0, 0.16f},         // under the nose
    Spot{{27, 9}, {11, 4}, &Palette::blush, 0.16f, 0.05f},           // under the eye
    Spot{{0, -55.5f}, {11, 2.6f}, &Palette::skin, 0, 0.14f},         // under the lower lip
    Spot{{26.5f, -42}, {2.8f, 2.8f}, &Palette::blush, 0.3f, 0.34f},  // corners of the mouth
};

}  // namespace

Paint SkinPaint(glm::vec3 place, const EyeAnatomy& eye, const Palette& palette) {
  const glm::vec2 half(std::abs(place.x), place.y);
  Paint paint{palette.skin, 1.0f};
  if (place.z > 40) {
    for (const Spot& spot : kSpots) {
      const glm::vec2 d = (half - spot.at) / spot.size;
      const float weight = std::exp(-0.5f * (d.x * d.x + d.y * d.y));
      paint.albedo = glm::mix(paint.albedo, palette.*spot.colour, spot.strength * weight);
      paint.open *= 1 - spot.shade * weight;
    }
  }
  if (palette.beard > 0) {
    // A shaved beard: upper lip, chin, jaw up to before the ear, and some of the throat.
    const float jaw_line = glm::mix(-26.0f, -8.0f, SmoothStep(30, 62, half.x));
    const float low =
        SmoothStep(jaw_line + 6, jaw_line - 22, half.y) * SmoothStep(-128, -100, half.y);
    const float front = SmoothStep(-12, 8, place.z);
    const float under_nose = SmoothStep(-23, -27, half.y);
    const float cheek = 1 - 0.75f * std::exp(-0.5f * (std::pow((half.x - 36) / 9, 2.0f) +
                                                      std::pow((half.y + 34) / 10, 2.0f)));
    const float shown = palette.beard * low * front * under_nose * cheek;
    paint.albedo *= glm::mix(glm::vec3(1), glm::vec3(0.66f, 0.70f, 0.76f), shown);
  }
  // Under the jaw, down to the throat.
  const float under = SmoothStep(-80, -92, place.y) * SmoothStep(-150, -108, place.y) *
                      SmoothStep(64, 52, place.z + 0.4f * (place.y + 88));
  paint.open *= 1 - 0.38f * under * SmoothStep(-30, 10, place.z);
  // The upper lid is a little darker and warmer, most in its fold and at its lashes.
  if (half.x > eye.inner_x() - 4 && half.x < eye.outer_x() + 5 && place.z > 40) {
    const float above = half.y - eye.UpperY(half.x);
    const float ends = SmoothStep(eye.inner_x() - 4, eye.inner_x() + 3, half.x) *
                       SmoothStep(eye.outer_x() + 5, eye.outer_x() - 3, half.x);
    const float fold = std::exp(-0.5f * (above - 5.0f) * (above - 5.0f) / 1.2f) * ends;
    const float lid = ends * SmoothStep(10, 2, above) * SmoothStep(-1, 0, above);
    paint.albedo =
        glm::mix(paint.albedo, palette.skin * glm::vec3(0.62f, 0.50f, 0.46f), 0.34f * lid);
    paint.open *= 1 - 0.18f * fold;
  }
  return paint;
}

}  // namespace fsm
