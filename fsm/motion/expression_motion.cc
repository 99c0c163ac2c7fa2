#include "fsm/motion/expression_motion.h"

namespace fsm {

void ExpressionMotion::Show(vm::Time now, const ActionUnits& look,
                            const std::array<double, kRegions>& lag_ms, const Sides& side_lag_ms,
                            vm::Time onset, vm::Time duration) {
  const bool timed = duration > vm::Time(0);
  if (timed) onset = std::min(onset, duration / 2);
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t part = 0; part < kRegions; ++part) {
      auto& track = parts_[side][part];
      // A part that begins late is as quick as the rest of the time allows.
      const vm::Time lag = std::min(FromMs(lag_ms[part] + side_lag_ms[side]), onset / 2);
      track.Plan(now, look, now + lag, onset - lag);
      if (timed) track.Plan(now, ActionUnits{}, now + duration - onset, onset);
    }
  }
  onset_end_ = now + onset;
  end_ = timed ? std::optional(now + duration) : std::nullopt;
}

void ExpressionMotion::Neutral(vm::Time now, vm::Time offset) {
  for (auto& side : parts_) {
    for (auto& part : side) part.Plan(now, ActionUnits{}, now, offset);
  }
  onset_end_ = now + offset;
  end_.reset();
}

ActionUnits ExpressionMotion::At(vm::Time t, const UnitList& list, double mouth_share) const {
  ActionUnits out;
  for (std::size_t part = 0; part < kRegions; ++part) {
    const ActionUnits left = parts_[0][part].At(t);
    const ActionUnits right = parts_[1][part].At(t);
    for (std::size_t unit = 0; unit < kActionUnits; ++unit) {
      if (static_cast<std::size_t>(list.region[unit]) != part) continue;
      const double share = list.region[unit] == Region::kMouth ? mouth_share : 1;
      out.left[unit] = static_cast<float>(share * left.left[unit]);
      out.right[unit] = static_cast<float>(share * right.right[unit]);
    }
    if (part != static_cast<std::size_t>(Region::kEye)) continue;
    // Eyes move together, whichever side of the face is first.
    out.gaze_left = left.gaze_left;
    out.gaze_right = left.gaze_right;
  }
  return out;
}

std::optional<vm::Time> ExpressionMotion::NextActivity(vm::Time t) const {
  std::optional<vm::Time> next;
  for (const auto& side : parts_) {
    for (const auto& part : side) next = Earlier(next, part.NextActivity(t));
  }
  return next;
}

}  // namespace fsm
