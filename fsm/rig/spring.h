#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace fsm {

/// A damped oscillator: a point of something soft, as of long hair, that swings about the place
/// where the head carries it (Simulation).
struct Spring {
  glm::vec3 rest{};  ///< the place at rest, millimetres
  glm::vec3 root{};  ///< the place it hangs from, at rest, millimetres
  /// The normal, of unit length, of the surface it lies on: it does not swing into that. 0: it
  /// swings in all directions.
  glm::vec3 outward{};
  float frequency_hz = 2;  ///< undamped; kLeastHz..kMostHz
  float damping = 0.3f;    ///< damping ratio (1 = critical), kLeastDamping..kMostDamping
  /// Where it comes to rest while the head leans, 0..1: 0 = leaning with the head, 1 = straight
  /// below `root`.
  float hang = 0;
  float most_mm = 20;  ///< limit of its distance from where the head carries it

  static constexpr float kLeastHz = 0.1f, kMostHz = 30;
  static constexpr float kLeastDamping = 0.01f, kMostDamping = 0.99f;
  static constexpr float kLeastMost = 0.01f, kMostMost = 1000;  ///< of most_mm
};

/// How far a vertex goes along with a spring, 0..1.
struct SpringWeight {
  std::uint32_t vertex;
  std::uint32_t spring;
  float weight;
};

/// What is soft, and what hangs on it: vertices of Bone::kSkull or kSkin.
struct SpringRig {
  std::vector<Spring> springs;
  std::vector<SpringWeight> weights;
};

}  // namespace fsm
