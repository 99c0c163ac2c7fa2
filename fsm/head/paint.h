#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "fsm/head/anatomy.h"

namespace fsm {

/// Colours of the generic head, linear RGB.
namespace palette {
inline constexpr glm::vec3 kSkin{0.66f, 0.425f, 0.325f};
inline constexpr glm::vec3 kBlush{0.62f, 0.28f, 0.22f};
inline constexpr glm::vec3 kLip{0.48f, 0.17f, 0.155f};
inline constexpr glm::vec3 kLipInside{0.36f, 0.11f, 0.10f};
inline constexpr glm::vec3 kRim{0.60f, 0.32f, 0.27f};
inline constexpr glm::vec3 kMouth{0.22f, 0.055f, 0.05f};
inline constexpr glm::vec3 kTongue{0.45f, 0.17f, 0.16f};
inline constexpr glm::vec3 kGum{0.46f, 0.18f, 0.17f};
inline constexpr glm::vec3 kTooth{0.70f, 0.67f, 0.58f};
inline constexpr glm::vec3 kSclera{0.66f, 0.64f, 0.62f};
inline constexpr glm::vec3 kBrow{0.10f, 0.055f, 0.035f};
inline constexpr glm::vec3 kLash{0.02f, 0.014f, 0.012f};
inline constexpr glm::vec3 kHair{0.105f, 0.052f, 0.030f};
inline constexpr glm::vec3 kCloth{0.075f, 0.13f, 0.21f};
}  // namespace palette

struct Paint {
  glm::vec3 albedo;
  float open;  ///< occlusion: 1 = open to the light
};

/// Colour and openness of the skin at a place of the face (both sides alike).
Paint SkinPaint(glm::vec2 domain, const EyeAnatomy& eye);

/// A fixed pseudo-random number in -1..1 for a lattice point: the same on every machine.
float Grain(int i, int j);

}  // namespace fsm
