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

/// The stage of the rig that remembers: what springs have done up to now, in steps of fixed length
/// that stand on a grid of the clock. So the same course of states gives the same offsets, however
/// often and when they are asked for. Rig::Evaluate lays them on a state.
///
/// Each spring follows x'' = w^2 (goal - x) - 2 d w (x' - goal'), w = 2 pi frequency, d = damping:
/// a damped oscillator (Meirovitch, Fundamentals of Vibrations, 2001, section 3.2) about a goal
/// that moves evenly within a step, for which each step is exact and no length of it unstable.
///
/// Thread: one at a time.
class Simulation {
 public:
  using Time = std::chrono::microseconds;
  using StateAt = std::function<FaceState(Time)>;
  static constexpr int kStepsPerSecond = 120;
  /// What lies further back counts as still: after a longer pause the steps begin anew there.
  static constexpr Time kMemory = std::chrono::seconds(3);

  explicit Simulation(std::vector<Spring> springs);

  /// Takes the steps up to `now`. `state_at` is asked for times from kMemory before `now` on, not
  /// below 0. A `now` before that of the last call begins anew.
  void RunTo(Time now, const StateAt& state_at);
  /// How far each spring is from where the head carries it, millimetres. None before the
  /// first RunTo.
  std::span<const glm::vec3> offsets() const { return offsets_; }
  /// Whether nothing swings so far that it would be seen.
  bool Still() const;

 private:
  /// One step of one spring: its distance from the goal and its speed become
  /// {a * away + b * speed, c * away + d * speed}.
  struct Step {
    float a, b, c, d;
  };
  struct Swing {
    glm::vec3 away{0}, speed{0};  // from the goal; millimetres, and per second
    glm::vec3 goal{0}, goal_speed{0};
  };
  static Step StepOf(const Spring& spring, float seconds);
  void Begin(std::int64_t step, const StateAt& state_at);
  void TakeStep(std::int64_t step, const StateAt& state_at);
  void FindOffsets(const FaceState& state, float ahead_s);

  std::vector<Spring> springs_;
  std::vector<Step> steps_;
  std::vector<Swing> swings_;
  std::vector<glm::vec3> offsets_;
  std::optional<std::int64_t> taken_;  // number of the last step, at taken_ / kStepsPerSecond
};

}  // namespace fsm
