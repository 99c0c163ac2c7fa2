#include "fsm/motion/head_motion.h"

#include <algorithm>
#include <cmath>

#include "fsm/motion/base/layer_names.h"
#include "fsm/motion/base/motion_errors.h"

namespace fsm {
namespace {
constexpr vm::Time kTurn = std::chrono::milliseconds(120);  // quick, but not at once
constexpr vm::Time kFade = std::chrono::milliseconds(80);
constexpr double kSmaller = 0.85;  // size of a repetition relative to the one before
}  // namespace

void HeadMotion::TurnTo(vm::Time now, const Angles& angles) { turn_.MoveTo(now, angles, kTurn); }

void HeadMotion::TurnBy(vm::Time now, const Angles& angles) {
  Angles target = turn_.TargetAt(now);
  for (std::size_t i = 0; i < 3; ++i) target[i] = std::clamp(target[i] + angles[i], -90.0f, 90.0f);
  TurnTo(now, target);
}

vm::Time HeadMotion::EndOf(const Movement& movement) {
  const vm::Time end = movement.start + FromMs(movement.curve->length_ms() * movement.count);
  return movement.stopped ? std::min(end, *movement.stopped + kFade) : end;
}

vm::Result<void> HeadMotion::Play(vm::Time now, std::string_view kind, int pattern, double strength,
                                  int count) {
  const auto found = patterns_.head.find(kind);
  const std::size_t patterns = found == patterns_.head.end() ? 0 : found->second.size();
  if (auto fits = CheckPatternNumber(kind, pattern, 1, patterns); !fits) return fits;
  StopMovements(now);
  const HeadCurve& curve = found->second[static_cast<std::size_t>(pattern - 1)];
  movements_.push_back({&curve, strength, count, now, std::nullopt});
  return {};
}

void HeadMotion::StopMovements(vm::Time now) {
  std::erase_if(movements_, [&](const Movement& movement) { return EndOf(movement) <= now; });
  for (Movement& movement : movements_) {
    if (!movement.stopped) movement.stopped = now;
  }
}

void HeadMotion::Contribute(vm::Time t, MotionLayers& layers) const {
  Angles& angles = layers.Layer(LayerName::kHead).head_rotation;
  angles = turn_.At(t);
  for (const Movement& movement : movements_) {
    if (t >= EndOf(movement)) continue;
    const double ms = std::max(0.0, InMs(t - movement.start));
    const double times = std::floor(ms / movement.curve->length_ms());
    const Angles more = movement.curve->At(ms - times * movement.curve->length_ms());
    const double fade =
        movement.stopped ? 1 - SmoothStep(Progress(t, *movement.stopped, kFade)) : 1;
    const double weight = fade * movement.strength * std::pow(kSmaller, times);
    for (std::size_t i = 0; i < 3; ++i) angles[i] += static_cast<float>(weight * more[i]);
  }
}

std::optional<vm::Time> HeadMotion::NextMotion(vm::Time t) const {
  return EndsAt(t) > t ? t : turn_.NextMotion(t);
}

vm::Time HeadMotion::EndsAt(vm::Time t) const {
  vm::Time end = t;
  for (const Movement& movement : movements_) end = std::max(end, EndOf(movement));
  return end;
}

}  // namespace fsm
