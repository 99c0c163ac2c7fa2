#include "fsm/motion/expression_motion.h"

namespace fsm {

void ExpressionMotion::Show(vm::Time now, const ActionUnits& look,
                            const std::array<double, kRegions>& lag_ms, vm::Time onset,
                            vm::Time duration) {
  const bool timed = duration > vm::Time(0);
  if (timed) onset = std::min(onset, duration / 2);
  for (std::size_t part = 0; part < kRegions; ++part) {
    // A part that begins late is as quick as the rest of the time allows.
    const vm::Time lag = std::min(FromMs(lag_ms[part]), onset / 2);
    parts_[part].Plan(now, look, now + lag, onset - lag);
    if (timed) parts_[part].Plan(now, ActionUnits{}, now + duration - onset, onset);
  }
  onset_end_ = now + onset;
  end_ = timed ? std::optional(now + duration) : std::nullopt;
}

void ExpressionMotion::Neutral(vm::Time now, vm::Time offset) {
  for (auto& part : parts_) part.Plan(now, ActionUnits{}, now, offset);
  onset_end_ = now + offset;
  end_.reset();
}

ActionUnits ExpressionMotion::At(vm::Time t, const UnitList& list, double mouth_share) const {
  std::array<ActionUnits, kRegions> looks;
  for (std::size_t part = 0; part < kRegions; ++part) looks[part] = parts_[part].At(t);
  ActionUnits out;
  for (std::size_t unit = 0; unit < kActionUnits; ++unit) {
    const Region region = list.region[unit];
    const double share = region == Region::kMouth ? mouth_share : 1;
    const ActionUnits& look = looks[static_cast<std::size_t>(region)];
    out.left[unit] = static_cast<float>(share * look.left[unit]);
    out.right[unit] = static_cast<float>(share * look.right[unit]);
  }
  const ActionUnits& eyes = looks[static_cast<std::size_t>(Region::kEye)];
  out.gaze_left = eyes.gaze_left;
  out.gaze_right = eyes.gaze_right;
  return out;
}

std::optional<vm::Time> ExpressionMotion::NextActivity(vm::Time t) const {
  std::optional<vm::Time> next;
  for (const auto& part : parts_) next = Earlier(next, part.NextActivity(t));
  return next;
}

}  // namespace fsm
