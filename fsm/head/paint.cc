#include "fsm/head/paint.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>

namespace fsm {
namespace {

/// A soft spot of paint on the face; `strength` mixes towards `colour`, `shade` takes off openness.
struct Spot {
  glm::vec2 at, size;
  glm::vec3 colour;
  float strength, shade;
};

// Where blood, shadow and make-up sit; places in the face's domain, millimetres.
const std::array kSpots = {
    Spot{{36, -8}, {15, 11}, palette::kBlush, 0.34f, 0},                      // cheeks
    Spot{{0, -9}, {9, 8}, palette::kBlush, 0.18f, 0},                         // tip of the nose
    Spot{{0, -74}, {12, 8}, palette::kBlush, 0.12f, 0},                       // chin
    Spot{{6.6f, -18.2f}, {3.0f, 1.7f}, {0.10f, 0.03f, 0.02f}, 0.94f, 0.92f},  // nostrils
    Spot{{18.0f, -15}, {2.6f, 6}, palette::kBlush, 0.25f, 0.16f},  // groove beside the nostril wing
    Spot{{0, -22.5f}, {10, 2.2f}, palette::kSkin, 0, 0.22f},       // under the nose
    Spot{{16.5f, 23}, {4.5f, 7}, palette::kBlush, 0.15f, 0.25f},   // inner corner of the socket
    Spot{{31, 11}, {11, 4}, palette::kBlush, 0.14f, 0.06f},        // under the eye
    Spot{{0, -54.5f}, {12, 3}, palette::kSkin, 0, 0.16f},          // under the lower lip
    Spot{{25.5f, -43}, {3.2f, 3}, palette::kBlush, 0.35f, 0.25f},  // corners of the mouth
    Spot{{0, -101}, {34, 13}, palette::kSkin, 0, 0.42f},           // under the chin
    Spot{{34, -97}, {26, 15}, palette::kSkin, 0, 0.34f},
};

}  // namespace

float Grain(int i, int j) {
  std::uint32_t h =
      static_cast<std::uint32_t>(i) * 0x9E3779B1u ^ static_cast<std::uint32_t>(j) * 0x85EBCA77u;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 13;
  return static_cast<float>(h & 0xFFFFu) / 32767.5f - 1.0f;
}

Paint SkinPaint(glm::vec2 domain, const EyeAnatomy& eye) {
  const glm::vec2 half(std::abs(domain.x), domain.y);
  Paint paint{palette::kSkin, 1.0f};
  for (const Spot& spot : kSpots) {
    const glm::vec2 d = (half - spot.at) / spot.size;
    const float weight = std::exp(-0.5f * (d.x * d.x + d.y * d.y));
    paint.albedo = glm::mix(paint.albedo, spot.colour, spot.strength * weight);
    paint.open *= 1 - spot.shade * weight;
  }
  // The upper lid is a little darker and warmer, most in its fold and at its lashes.
  if (half.x > eye.inner_x() - 4 && half.x < eye.outer_x() + 5) {
    const float above = half.y - eye.UpperY(half.x);
    const float ends = SmoothStep(eye.inner_x() - 4, eye.inner_x() + 3, half.x) *
                       SmoothStep(eye.outer_x() + 5, eye.outer_x() - 3, half.x);
    const float fold = std::exp(-0.5f * (above - 3.8f) * (above - 3.8f) / 0.9f) * ends;
    const float lid = ends * SmoothStep(9, 2, above) * SmoothStep(-1, 0, above);
    paint.albedo = glm::mix(paint.albedo, glm::vec3(0.40f, 0.21f, 0.16f), 0.42f * lid);
    paint.open *= 1 - 0.42f * fold;
  }
  return paint;
}

}  // namespace fsm
