#pragma once

#include <array>
#include <optional>

#include "fsm/motion/emotion_table.h"
#include "fsm/motion/track.h"

namespace fsm {

/// One emotion at a time on the face, crossfaded into the next; each part of the face begins by
/// its own lag, and one side of it may begin later than the other. Commands come in order of time;
/// queries are for now or later.
class ExpressionMotion {
 public:
  using Sides = std::array<double, 2>;  ///< the agent's left, right

  /// `look` is the whole target. The onset takes `onset` including the lags. With a `duration` (not
  /// zero) the expression is gone `duration` after now: for short ones onset and offset take half
  /// of it each. `side_lag_ms`: how much later each side begins.
  void Show(vm::Time now, const ActionUnits& look, const std::array<double, kRegions>& lag_ms,
            const Sides& side_lag_ms, vm::Time onset, vm::Time duration);
  void Neutral(vm::Time now, vm::Time offset);

  /// `mouth_share` multiplies the units of the mouth.
  ActionUnits At(vm::Time t, const UnitList& list, double mouth_share) const;
  vm::Time SettledAt(vm::Time t) const { return std::max(t, onset_end_); }
  std::optional<vm::Time> NextActivity(vm::Time t) const;
  /// When the timed expression will be gone; none if it holds or there is none.
  std::optional<vm::Time> End() const { return end_; }

 private:
  // By side, then by part; of each only its side's units are used.
  std::array<std::array<Track<ActionUnits>, kRegions>, 2> parts_;
  vm::Time onset_end_{0};
  std::optional<vm::Time> end_;
};

}  // namespace fsm
