#include "fsm/motion/eye_motion.h"

#include <cmath>
#include <numbers>

#include "fsm/motion/base/fixations.h"
#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/base/random_streams.h"
#include "fsm/motion/inputs/motion_inputs.h"

namespace fsm {

EyeMotion::EyeMotion(const MotionInputs& in)
    : patterns_(in.tables.motions),
      gestures_(in.tables.gestures),
      settings_(in.settings),
      switches_(in.switches),
      seed_(in.seed) {}

float EyeMotion::HeadShareOf(float angle) const {
  const float beyond = std::max(0.0f, std::abs(angle) - gestures_.gaze.eyes_only_deg);
  return std::copysign(beyond * gestures_.gaze.head_share, angle);
}

EyeAngles EyeMotion::Thinking() const {
  return {gestures_.think.down_deg.start, gestures_.think.aside_deg.start};
}

// ---- commands

void EyeMotion::Rotate(vm::Time now, const Sided<bool>& sides, const EyeAngles& angles,
                       vm::Time duration) {
  for (const Side side : kSides) {
    if (!sides[side]) continue;
    rotation_[side].Visit(now, angles, settings_.eye_move, duration);
    ends_.rotation[side] = duration > vm::Time(0) ? now + duration : now;
  }
}

void EyeMotion::SetAim(vm::Time now, Aim aim, const EyeAngles& angles, vm::Time duration) {
  on_user_.MoveTo(now, aim == Aim::kUser ? 1.0f : 0.0f, 2 * settings_.eye_move);
  thinking_.MoveTo(now, aim == Aim::kThought ? 1.0f : 0.0f, settings_.eye_move);
  if (aim == Aim::kThought) thinking_since_ = now;
  const double near = settings_.gaze_distance_mm;
  const double angle =
      aim == Aim::kThought || near <= 0
          ? 0
          : std::atan2(gestures_.gaze.half_pupil_distance_mm, near) * 180 / std::numbers::pi;
  vergence_deg_.MoveTo(now, static_cast<float>(angle), 2 * settings_.eye_move);
  gaze_.Visit(now, angles, settings_.eye_move, duration);
  head_share_.Visit(now, {HeadShareOf(angles[kDown]), HeadShareOf(angles[kToRight])},
                    FromMs(gestures_.gaze.head_ms), duration);
  ends_.gaze = duration > vm::Time(0) ? now + duration : now;
}

void EyeMotion::BlinkAtShift(vm::Time now, const EyeAngles& from, const EyeAngles& to) {
  if (!switches_[IdleKind::kGazeBlink].on() || patterns_.blinks.empty()) return;
  const double angle = std::hypot(to[kDown] - from[kDown], to[kToRight] - from[kToRight]);
  const double chance = std::clamp(angle / gestures_.shift_blink.certain_from_deg, 0.0,
                                   double{gestures_.shift_blink.max_chance});
  if ((RandomAt(seed_, RandomStream::kShiftBlink, ++shifts_) + 1) / 2 < chance) Blink(now, 1);
}

void EyeMotion::Gaze(vm::Time now, const EyeAngles& angles, vm::Time duration) {
  BlinkAtShift(now, gaze_.TargetAt(now), angles);
  SetAim(now, Aim::kPlace, angles, duration);
}

void EyeMotion::GazeAtUser(vm::Time now) {
  BlinkAtShift(now, thinking_.TargetAt(now) > 0 ? Thinking() : gaze_.TargetAt(now), {0, 0});
  SetAim(now, Aim::kUser, {0, 0}, vm::Time(0));
}

void EyeMotion::Think(vm::Time now) {
  BlinkAtShift(now, gaze_.TargetAt(now), Thinking());
  SetAim(now, Aim::kThought, {0, 0}, vm::Time(0));
}

void EyeMotion::Blink(vm::Time now, std::size_t pattern, int count) {
  const BlinkPattern& blink = PatternAt(patterns_.blinks, pattern);
  std::erase_if(blinks_, [&](const Blinking& b) { return b.start + LengthOf(b.pattern) <= now; });
  for (int i = 0; i < count; ++i) blinks_.push_back({blink, now + i * LengthOf(blink)});
}

// ---- as a source

EyeAngles EyeMotion::ThinkingAt(vm::Time t) const {
  const MovementNumbers::Think& think = gestures_.think;
  const auto saccade_ms = [&](std::int64_t k) {
    return k == 0 ? 0
                  : think.interval_ms *
                        (static_cast<double>(k) +
                         think.interval_variation * RandomAt(seed_, RandomStream::kThinkTime, k));
  };
  const double habit = RandomAt(seed_, RandomStream::kThinkSide, 0);
  const auto place = [&](std::int64_t index) -> std::array<double, 2> {
    if (index < 0) return {0, 0};
    const double side = std::copysign(
        1, habit + think.side_switch * RandomAt(seed_, RandomStream::kThinkSide, index + 1));
    const auto varied = [&](Linear angle, std::int64_t at) {
      return angle.At(static_cast<float>(RandomAt(seed_, RandomStream::kThinkHeight, at)));
    };
    return {varied(think.down_deg, index), side * varied(think.aside_deg, index + 50)};
  };
  return FixationAt(std::max(0.0, InMs(t - thinking_since_)), think.interval_ms, saccade_ms, place,
                    [&](const auto&, const auto&) { return think.jump_ms; });
}

double EyeMotion::BlinkAt(vm::Time t) const {
  double shut = 0;
  for (const Blinking& blink : blinks_) {
    shut = std::max(shut, LidsAt(blink.pattern, t - blink.start));
  }
  return shut;
}

void EyeMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  MotionLayer& layer = layers.Layer(LayerName::kEyes);
  const float thinking = thinking_.At(t), vergence = vergence_deg_.At(t);
  const EyeAngles thought = thinking > 0 ? ThinkingAt(t) : EyeAngles{};
  const EyeAngles left = rotation_.left.At(t), right = rotation_.right.At(t);
  const EyeAngles gaze = gaze_.At(t), head = head_share_.At(t);
  for (const auto axis : {kDown, kToRight}) {
    const float both = gaze[axis] - head[axis] + thinking * thought[axis];
    layer.look.gaze.left[axis] = left[axis] + both;
    layer.look.gaze.right[axis] = right[axis] + both;
    layer.head_rotation[axis] = head[axis];
  }
  layer.look.gaze.left[kToRight] -= vergence;
  layer.look.gaze.right[kToRight] += vergence;
  layer.blink.left = layer.blink.right = static_cast<float>(BlinkAt(t));
  layers.AddSignal(SignalName::kAtUser, on_user_.At(t));
}

vm::Time EyeMotion::BlinksEnd(vm::Time t) const {
  vm::Time end = t;
  for (const Blinking& b : blinks_) end = std::max(end, b.start + LengthOf(b.pattern));
  return end;
}

vm::Time EyeMotion::EndsAt(vm::Time t) const {
  return std::max({t, BlinksEnd(t), ends_.rotation.left, ends_.rotation.right, ends_.gaze});
}

std::optional<vm::Time> EyeMotion::NextMotion(vm::Time t) const {
  if (BlinksEnd(t) > t || thinking_.At(t) > 0) return t;
  return MotionSource::NextMotion(t);
}

void EyeMotion::ForEachTrack(const TrackVisitor& visit) const {
  for (const auto* track : {&rotation_.left, &rotation_.right, &gaze_, &head_share_}) visit(*track);
  for (const auto* track : {&on_user_, &thinking_, &vergence_deg_}) visit(*track);
}

}  // namespace fsm
