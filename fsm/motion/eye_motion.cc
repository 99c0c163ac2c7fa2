#include "fsm/motion/eye_motion.h"

#include <cmath>

namespace fsm {
namespace {

constexpr vm::Time kHeadFollows = std::chrono::milliseconds(320);
constexpr double kEyesAlone = 12;   // degrees the eyes turn without the head
constexpr double kHeadShare = 0.6;  // of what is beyond

// There within `move`, and if timed, back when `duration` is over.
void ThereAndBack(Track<EyeAngles>& track, vm::Time now, const EyeAngles& there, vm::Time move,
                  vm::Time duration) {
  const bool timed = duration > vm::Time(0);
  if (timed) move = std::min(move, duration / 2);
  track.Plan(now, there, now, move);
  if (timed) track.Plan(now, EyeAngles{}, now + duration - move, move);
}

float Beyond(float angle) {
  const double more = std::max(0.0, std::abs(angle) - kEyesAlone) * kHeadShare;
  return static_cast<float>(std::copysign(more, angle));
}

}  // namespace

vm::Time LengthOf(const BlinkPattern& pattern) {
  return FromMs(pattern.closing_ms + pattern.shut_ms + pattern.opening_ms);
}

double LidsAt(const BlinkPattern& pattern, vm::Time since) {
  const double ms = InMs(since);
  if (ms <= 0) return 0;
  if (ms < pattern.closing_ms) return SmoothStep(ms / pattern.closing_ms);
  const double opening = ms - pattern.closing_ms - pattern.shut_ms;
  if (opening <= 0) return 1;
  if (opening >= pattern.opening_ms) return 0;
  return 1 - SmoothStep(opening / pattern.opening_ms);
}

void EyeMotion::Turn(vm::Time now, bool left, bool right, const EyeAngles& angles, vm::Time move,
                     vm::Time duration) {
  if (left) ThereAndBack(left_, now, angles, move, duration);
  if (right) ThereAndBack(right_, now, angles, move, duration);
  end_ = duration > vm::Time(0) ? std::optional(now + duration) : std::nullopt;
}

void EyeMotion::Gaze(vm::Time now, const EyeAngles& angles, vm::Time move, vm::Time duration) {
  ThereAndBack(gaze_, now, angles, move, duration);
  ThereAndBack(head_share_, now, {Beyond(angles[0]), Beyond(angles[1])}, kHeadFollows, duration);
  end_ = duration > vm::Time(0) ? std::optional(now + duration) : std::nullopt;
}

void EyeMotion::Blink(vm::Time now, const BlinkPattern& pattern) {
  std::erase_if(blinks_, [&](const Blinking& b) { return b.start + LengthOf(b.pattern) <= now; });
  blinks_.push_back({pattern, now});
}

EyeAngles EyeMotion::LeftAt(vm::Time t) const {
  const EyeAngles turn = left_.At(t), gaze = gaze_.At(t), head = head_share_.At(t);
  return {turn[0] + gaze[0] - head[0], turn[1] + gaze[1] - head[1]};
}

EyeAngles EyeMotion::RightAt(vm::Time t) const {
  const EyeAngles turn = right_.At(t), gaze = gaze_.At(t), head = head_share_.At(t);
  return {turn[0] + gaze[0] - head[0], turn[1] + gaze[1] - head[1]};
}

double EyeMotion::LidsShutAt(vm::Time t) const {
  double shut = 0;
  for (const Blinking& blink : blinks_)
    shut = std::max(shut, LidsAt(blink.pattern, t - blink.start));
  return shut;
}

vm::Time EyeMotion::SettledAt(vm::Time t) const {
  return std::max(
      {left_.SettledAt(t), right_.SettledAt(t), gaze_.SettledAt(t), head_share_.SettledAt(t)});
}

vm::Time EyeMotion::BlinksEnd(vm::Time t) const {
  vm::Time end = t;
  for (const Blinking& b : blinks_) end = std::max(end, b.start + LengthOf(b.pattern));
  return end;
}

std::optional<vm::Time> EyeMotion::NextActivity(vm::Time t) const {
  if (BlinksEnd(t) > t) return t;
  return Earlier(Earlier(left_.NextActivity(t), right_.NextActivity(t)),
                 Earlier(gaze_.NextActivity(t), head_share_.NextActivity(t)));
}

}  // namespace fsm
