#include "fsm/rig/simulation.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "fsm/base/pi.h"
#include "fsm/rig/pose.h"

namespace fsm {
namespace {

constexpr float kStepSeconds = 1.0f / Simulation::kStepsPerSecond;

std::int64_t StepAt(Simulation::Time t) {
  return t.count() * Simulation::kStepsPerSecond / 1'000'000;
}

/// How the head carries a spring's points in one state.
struct Carrier {
  explicit Carrier(const FaceState& state)
      : rotation(HeadRotation(state)), forward(HeadForward(state)) {
    // `upright` is the rotation's component about the vertical axis (yaw).
    const glm::vec3 ahead = rotation[2];
    const float length = std::hypot(ahead.x, ahead.z);
    const float c = length > 1e-3f ? ahead.z / length : 1,
                s = length > 1e-3f ? ahead.x / length : 0;
    upright = {c, 0, -s, 0, 1, 0, s, 0, c};
  }
  glm::vec3 Carried(glm::vec3 p) const {
    return kNeckPivot + rotation * (p - kNeckPivot) + glm::vec3(0, 0, forward);
  }
  /// Returns the offset of a spring's equilibrium from the place where the head carries it.
  glm::vec3 Hanging(const Spring& spring) const {
    const glm::vec3 below = spring.rest - spring.root;
    return spring.hang * (upright * below - rotation * below);
  }
  glm::mat3 rotation, upright{};
  float forward;
};

}  // namespace

Simulation::Simulation(std::vector<Spring> springs)
    : springs_(std::move(springs)), motions_(springs_.size()) {
  for (const Spring& spring : springs_) propagators_.push_back(PropagatorOf(spring, kStepSeconds));
}

Simulation::Propagator Simulation::PropagatorOf(const Spring& spring, float seconds) {
  const float w = 2 * kPi * spring.frequency_hz;
  const float decay = spring.damping * w;
  const float damped = w * std::sqrt(1 - spring.damping * spring.damping);
  const float e = std::exp(-decay * seconds);
  const float c = e * std::cos(damped * seconds);
  const float s = e * std::sin(damped * seconds) / damped;
  return {.a = c + decay * s, .b = s, .c = -w * w * s, .d = c - decay * s};
}

void Simulation::RunTo(Time now, const StateAt& state_at) {
  if (springs_.empty()) return;
  now = std::max(now, Time(0));
  const std::int64_t last = StepAt(now);
  if (!taken_ || *taken_ > last || *taken_ < StepAt(now - kMemory)) {
    Begin(std::max<std::int64_t>(StepAt(now - kMemory), 0), state_at);
  }
  while (*taken_ < last) Advance(*taken_ + 1, state_at);
  const double ahead = static_cast<double>(now.count()) / 1e6 -
                       static_cast<double>(last) / Simulation::kStepsPerSecond;
  ComputeOffsets(state_at(now), static_cast<float>(ahead));
}

void Simulation::Begin(std::int64_t step, const StateAt& state_at) {
  std::ranges::fill(motions_, SpringMotion{});
  taken_ = step - 1;
  Advance(step, state_at);
  for (SpringMotion& motion : motions_) {
    motion.away = motion.speed = motion.goal_speed = glm::vec3(0);
  }
}

void Simulation::Advance(std::int64_t step, const StateAt& state_at) {
  const Carrier carrier(state_at(Time(step * 1'000'000 / kStepsPerSecond)));
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    SpringMotion& motion = motions_[i];
    const glm::vec3 goal = carrier.Carried(springs_[i].rest) + carrier.Hanging(springs_[i]);
    const glm::vec3 goal_speed = (goal - motion.goal) / kStepSeconds;
    const glm::vec3 away = motion.away, speed = motion.speed - (goal_speed - motion.goal_speed);
    const auto [a, b, c, d] = propagators_[i];
    motion = {.away = a * away + b * speed,
              .speed = c * away + d * speed,
              .goal = goal,
              .goal_speed = goal_speed};
  }
  taken_ = step;
}

void Simulation::ComputeOffsets(const FaceState& state, float ahead_s) {
  const Carrier carrier(state);
  offsets_.resize(springs_.size());
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const Spring& spring = springs_[i];
    const auto [a, b, c, d] = PropagatorOf(spring, ahead_s);
    const glm::vec3 away = a * motions_[i].away + b * motions_[i].speed;
    glm::vec3 offset = carrier.Hanging(spring) + away;
    const glm::vec3 outward = carrier.rotation * spring.outward;
    offset -= std::min(glm::dot(offset, outward), 0.0f) * outward;
    // An offset saturates: the closer to its limit, the less it grows.
    const float length = glm::length(offset);
    offsets_[i] = offset * (spring.reach_mm / std::hypot(spring.reach_mm, length));
  }
}

bool Simulation::Still() const {
  constexpr float kSeenMm = 0.05f;
  return std::ranges::all_of(motions_, [](const SpringMotion& motion) {
    return glm::length(motion.away) < kSeenMm && glm::length(motion.speed) < 10 * kSeenMm;
  });
}

}  // namespace fsm
