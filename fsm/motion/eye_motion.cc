#include "fsm/motion/eye_motion.h"

#include <cmath>
#include <numbers>

#include "fsm/motion/random_streams.h"

namespace fsm {
namespace {

constexpr vm::Time kHeadFollows = std::chrono::milliseconds(320);
constexpr double kHalfPupilsMm = 31;  // half the distance between the pupils

// Moves to a target within `move`; if `duration` is not zero, returns to rest by its end.
void ThereAndBack(Track<EyeAngles>& track, vm::Time now, const EyeAngles& there, vm::Time move,
                  vm::Time duration) {
  const bool timed = duration > vm::Time(0);
  if (timed) move = std::min(move, duration / 2);
  track.Plan(now, there, now, move);
  if (timed) track.Plan(now, EyeAngles{}, now + duration - move, move);
}

}  // namespace

float EyeMotion::HeadShareOf(float angle) const {
  const float beyond = std::max(0.0f, std::abs(angle) - gestures_.gaze.alone);
  return std::copysign(beyond * gestures_.gaze.head, angle);
}

EyeAngles EyeMotion::Thinking() const { return {gestures_.think.down.x, gestures_.think.aside.x}; }

// ---- commands

void EyeMotion::Turn(vm::Time now, bool left, bool right, const EyeAngles& angles,
                     vm::Time duration) {
  for (const Side side : kSides) {
    if (!(side == Side::kLeft ? left : right)) continue;
    ThereAndBack(turned_[side], now, angles, settings_.eye_move, duration);
    ends_.turned[side] = duration > vm::Time(0) ? now + duration : now;
  }
}

void EyeMotion::LookAt(vm::Time now, Aim aim, const EyeAngles& angles, vm::Time duration) {
  on_user_.MoveTo(now, aim == Aim::kUser ? 1.0f : 0.0f, 2 * settings_.eye_move);
  thinking_.MoveTo(now, aim == Aim::kNothing ? 1.0f : 0.0f, settings_.eye_move);
  if (aim == Aim::kNothing) thinking_since_ = now;
  const double near = settings_.gaze_distance_mm;
  const double angle = aim == Aim::kNothing || near <= 0
                           ? 0
                           : std::atan2(kHalfPupilsMm, near) * 180 / std::numbers::pi;
  vergence_deg_.MoveTo(now, static_cast<float>(angle), 2 * settings_.eye_move);
  ThereAndBack(gaze_, now, angles, settings_.eye_move, duration);
  ThereAndBack(head_share_, now, {HeadShareOf(angles[kDown]), HeadShareOf(angles[kToRight])},
               kHeadFollows, duration);
  ends_.gaze = duration > vm::Time(0) ? now + duration : now;
}

void EyeMotion::BlinkAtShift(vm::Time now, const EyeAngles& from, const EyeAngles& to) {
  if (!idle_.On(IdleKind::kGazeBlink) || patterns_.blinks.empty()) return;
  const double angle = std::hypot(to[kDown] - from[kDown], to[kToRight] - from[kToRight]);
  // Blinks accompany nearly all large gaze shifts and few small ones (Evinger et al., Not looking
  // while leaping, 1994).
  const double chance = std::clamp(angle / 20, 0.0, 0.95);
  if ((RandomAt(seed_, RandomStream::kShiftBlink, ++shifts_) + 1) / 2 < chance) Blink(now, 1);
}

void EyeMotion::Gaze(vm::Time now, const EyeAngles& angles, vm::Time duration) {
  BlinkAtShift(now, gaze_.TargetAt(now), angles);
  LookAt(now, Aim::kPlace, angles, duration);
}

void EyeMotion::LookAtUser(vm::Time now) {
  BlinkAtShift(now, thinking_.TargetAt(now) > 0 ? Thinking() : gaze_.TargetAt(now), {0, 0});
  LookAt(now, Aim::kUser, {0, 0}, vm::Time(0));
}

void EyeMotion::Think(vm::Time now) {
  BlinkAtShift(now, gaze_.TargetAt(now), Thinking());
  LookAt(now, Aim::kNothing, {0, 0}, vm::Time(0));
}

void EyeMotion::Blink(vm::Time now, std::size_t pattern, int count) {
  const BlinkPattern& blink = PatternAt(patterns_.blinks, pattern);
  std::erase_if(blinks_, [&](const Blinking& b) { return b.start + LengthOf(b.pattern) <= now; });
  for (int i = 0; i < count; ++i) blinks_.push_back({blink, now + i * LengthOf(blink)});
}

// ---- as a source

EyeAngles EyeMotion::ThinkingAt(vm::Time t) const {
  constexpr double kStay = 1500;  // ms
  const auto jump_ms = [&](std::int64_t k) {
    return k == 0 ? 0
                  : kStay * (static_cast<double>(k) +
                             0.35 * RandomAt(seed_, RandomStream::kThinkTime, k));
  };
  const double ms = std::max(0.0, InMs(t - thinking_since_));
  auto k = static_cast<std::int64_t>(std::floor(ms / kStay));
  if (ms < jump_ms(k)) --k;
  if (ms >= jump_ms(k + 1)) ++k;
  // Mostly up and to one side, which depends on the seed and changes occasionally.
  const double habit = RandomAt(seed_, RandomStream::kThinkSide, 0);
  const auto place = [&](std::int64_t index) -> std::array<double, 2> {
    if (index < 0) return {0, 0};
    const double side =
        std::copysign(1, habit + 0.8 * RandomAt(seed_, RandomStream::kThinkSide, index + 1));
    const auto varied = [&](glm::vec2 row, std::int64_t at) {
      return Linear(row, static_cast<float>(RandomAt(seed_, RandomStream::kThinkHeight, at)));
    };
    return {varied(gestures_.think.down, index), side * varied(gestures_.think.aside, index + 50)};
  };
  const auto from = place(k - 1), to = place(k);
  const double u = SmootherStep((ms - jump_ms(k)) / 55);
  return {static_cast<float>(from[kDown] + u * (to[kDown] - from[kDown])),
          static_cast<float>(from[kToRight] + u * (to[kToRight] - from[kToRight]))};
}

double EyeMotion::LidsShutAt(vm::Time t) const {
  double shut = 0;
  for (const Blinking& blink : blinks_) {
    shut = std::max(shut, LidsAt(blink.pattern, t - blink.start));
  }
  return shut;
}

void EyeMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  MotionLayer& layer = layers.Layer("eyes");
  const float thinking = thinking_.At(t), vergence = vergence_deg_.At(t);
  const EyeAngles thought = thinking > 0 ? ThinkingAt(t) : EyeAngles{};
  const EyeAngles left = turned_.left.At(t), right = turned_.right.At(t);
  const EyeAngles gaze = gaze_.At(t), head = head_share_.At(t);
  for (const auto turn : {kDown, kToRight}) {
    const float both = gaze[turn] - head[turn] + thinking * thought[turn];
    layer.units.gaze.left[turn] = left[turn] + both;
    layer.units.gaze.right[turn] = right[turn] + both;
    layer.head[turn] = head[turn];
  }
  layer.units.gaze.left[kToRight] -= vergence;
  layer.units.gaze.right[kToRight] += vergence;
  layer.lids_shut = static_cast<float>(LidsShutAt(t));
  layers.AddSignal("at_user", on_user_.At(t));
}

vm::Time EyeMotion::BlinksEnd(vm::Time t) const {
  vm::Time end = t;
  for (const Blinking& b : blinks_) end = std::max(end, b.start + LengthOf(b.pattern));
  return end;
}

vm::Time EyeMotion::FiniteEnd(vm::Time t) const {
  return std::max({t, BlinksEnd(t), ends_.turned.left, ends_.turned.right, ends_.gaze});
}

std::optional<vm::Time> EyeMotion::NextActivity(vm::Time t) const {
  if (BlinksEnd(t) > t || thinking_.At(t) > 0) return t;
  return MotionSource::NextActivity(t);
}

void EyeMotion::ForEachTrack(const TrackVisitor& visit) const {
  for (const auto* track : {&turned_.left, &turned_.right, &gaze_, &head_share_}) visit(*track);
  for (const auto* track : {&on_user_, &thinking_, &vergence_deg_}) visit(*track);
}

}  // namespace fsm
