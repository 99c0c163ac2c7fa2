#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace fsm {

/// A place of something soft, as of long hair, that swings about where the head carries it. See
/// Simulation.
struct Spring {
  glm::vec3 rest{};     ///< millimetres
  glm::vec3 root{};     ///< what it hangs from, at rest, millimetres
  glm::vec3 outward{};  ///< away from what it lies on, unit: it never swings inward; 0: it may
  float frequency_hz = 2;
  float damping = 0.3f;  ///< of the critical, kLeastDamping..kMostDamping
  float hang = 0;        ///< as the head leans: 0 it leans with it, 1 it hangs straight from `root`
  float most_mm = 20;    ///< it comes no further from where the head carries it

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
