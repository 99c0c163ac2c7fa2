#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "fsm/rig/face_state.h"
#include "fsm/rig/spring.h"

namespace fsm {

/// The part of the rig that has a memory: the motion of springs, integrated in steps of fixed
/// length on a fixed grid of time. The same course of states therefore gives the same offsets,
/// however often and when they are asked for. Rig::Evaluate adds the offsets to a state.
///
/// Each spring follows x'' = w^2 (goal - x) - 2 d w (x' - goal'), w = 2 pi frequency, d = damping:
/// a damped oscillator (Meirovitch, Fundamentals of Vibrations, 2001, section 3.2) about a goal
/// that moves uniformly within a step. Steps are exact solutions, hence stable at any length.
///
/// Thread: one at a time.
class Simulation {
 public:
  using Time = std::chrono::microseconds;
  using StateAt = std::function<FaceState(Time)>;
  static constexpr int kStepsPerSecond = 120;
  /// Motion further back is ignored: after a longer pause the integration restarts from stillness.
  static constexpr Time kMemory = std::chrono::seconds(3);

  explicit Simulation(std::vector<Spring> springs);

  /// Integrates up to `now`. `state_at` is called for times from `now` - kMemory on, never below 0.
  /// A `now` before that of the last call restarts the simulation.
  void RunTo(Time now, const StateAt& state_at);
  /// Returns how far each spring is from where the head carries it, in millimetres. Empty before
  /// the first RunTo.
  std::span<const glm::vec3> offsets() const { return offsets_; }
  /// Tells whether no spring swings visibly.
  bool Still() const;

 private:
  /// The exact propagator of one spring over one step: offset from the goal and speed become
  /// {a * away + b * speed, c * away + d * speed}.
  struct Propagator {
    float a, b, c, d;
  };
  struct SpringMotion {
    glm::vec3 away{0}, speed{0};  // relative to the goal; millimetres and mm/s
    glm::vec3 goal{0}, goal_speed{0};
  };
  static Propagator PropagatorOf(const Spring& spring, float seconds);
  void Begin(std::int64_t step, const StateAt& state_at);
  void Advance(std::int64_t step, const StateAt& state_at);
  void ComputeOffsets(const FaceState& state, float ahead_s);

  std::vector<Spring> springs_;
  std::vector<Propagator> propagators_;
  std::vector<SpringMotion> motions_;
  std::vector<glm::vec3> offsets_;
  std::optional<std::int64_t> taken_;  // number of the last step; its time: / kStepsPerSecond
};

}  // namespace fsm
