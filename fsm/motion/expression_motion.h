#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "fsm/motion/idle_behaviour.h"
#include "fsm/motion/motion_settings.h"
#include "fsm/motion/motion_source.h"
#include "fsm/motion/motion_tables.h"
#include "fsm/motion/random_streams.h"

namespace fsm {

/// Expressions, on the layer `expression`: one at a time, crossfaded into the next; each part of
/// the face begins by its own lag, and one side of it may begin later than the other. And the
/// emotions of the list of units (Face.31 and on), on the layer `emotions`: each by itself.
/// It gives the signal `expression`: how much of either is shown.
/// It also keeps the expressions that are defined while running, in the tables.
/// Lifetime: what it is made with outlives it. Commands come in order of time.
/// Errors: kBadValue with what there is; kLimit for too many expressions.
class ExpressionMotion : public MotionSource {
 public:
  ExpressionMotion(MotionTables& tables, const MotionSettings& settings, const IdleBehaviour& idle,
                   std::uint64_t seed);

  /// With a `duration` (not zero) the expression is gone `duration` after now: for short ones onset
  /// and offset take half of it each.
  vm::Result<void> Show(vm::Time now, std::string_view name, int pattern, double strength,
                        vm::Time duration);
  /// The expression at a point of the tables' emotion space, there within `move` or, without it, as
  /// long as expressions take.
  void ShowPoint(vm::Time now, const EmotionSpace::Point& point, std::optional<vm::Time> move);
  void Neutral(vm::Time now);
  /// REQUIRES: the list of units has an emotion there, from 0.
  void SetEmotion(vm::Time now, std::size_t index, double strength);
  /// Makes or changes one pattern of an expression; a new expression begins with pattern 1, a new
  /// pattern is the next. The name: letters, digits and _.
  vm::Result<void> Define(std::string_view name, int pattern, std::string_view look);
  /// Back to what the tables say: a changed expression is what it was, an own one is gone.
  void Forget(std::string_view name);
  /// Whose face it is: by how much one side of it begins later than the other, always the same: 20
  /// to 40 ms. How much weaker one side is belongs to the head.
  void SetPerson(std::uint64_t person) { DrawLags(Scramble(seed_ ^ person)); }

  void Contribute(vm::Time t, MotionLayers& layers) const override;
  vm::Time SettledAt(vm::Time t) const override;
  vm::Time FiniteEnd(vm::Time t) const override { return end_.value_or(t); }

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  void DrawLags(std::uint64_t seed);
  vm::Time OnsetOf(const Emotion& emotion) const;
  void Plan(vm::Time now, const ActionUnits& look, const Emotion::Timing& timing, vm::Time onset,
            vm::Time duration);

  MotionTables& tables_;
  const EmotionTable table_emotions_;  // as they were at the start
  const MotionSettings& settings_;
  const IdleBehaviour& idle_;
  std::uint64_t seed_;
  Sided<double> side_lags_ms_;
  // By part; of each only its side's units are used.
  Sided<std::array<Track<ActionUnits>, kRegions>> parts_;
  Track<float> shown_;                  // how much an expression is shown, 0..1
  std::vector<Track<float>> emotions_;  // by position in the list of units
  vm::Time onset_end_{0};
  std::optional<vm::Time> end_;  // of a timed expression
};

}  // namespace fsm
