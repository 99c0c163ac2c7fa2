#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace fsm {

/// A damped oscillator: a point of a soft part, such as long hair, that swings about the place
/// where the head carries it (Simulation).
struct Spring {
  glm::vec3 rest{};  ///< at rest, millimetres
  glm::vec3 root{};  ///< the point it hangs from, at rest, millimetres
  /// Unit normal of the surface it lies on, into which it does not swing. 0: it swings in all
  /// directions.
  glm::vec3 outward{};
  float frequency_hz = 2;  ///< undamped natural frequency, kMinHz..kMaxHz
  float damping = 0.3f;    ///< damping ratio (1 = critical), kMinDamping..kMaxDamping
  /// Equilibrium while the head leans, 0..1: 0 = leaning with the head, 1 = straight below `root`.
  float hang = 0;
  float reach_mm = 20;  ///< limit of its distance from where the head carries it

  static constexpr float kMinHz = 0.1f, kMaxHz = 30;
  static constexpr float kMinDamping = 0.01f, kMaxDamping = 0.99f;
  static constexpr float kMinReachMm = 0.01f, kMaxReachMm = 1000;  ///< limits of reach_mm
};

/// The share of a spring's offset that a vertex takes, 0..1.
struct SpringWeight {
  std::uint32_t vertex;
  std::uint32_t spring;
  float weight;
};

/// The springs and the vertices that hang on them, which are of Bone::kSkull or kSkin.
struct SpringRig {
  std::vector<Spring> springs;
  std::vector<SpringWeight> weights;
};

}  // namespace fsm
