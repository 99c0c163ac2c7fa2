#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/base/random_streams.h"
#include "fsm/motion/inputs/emotion_space.h"
#include "fsm/motion/inputs/expression_table.h"
#include "fsm/motion/inputs/motion_settings.h"

namespace fsm {

class IdleSwitches;
struct MotionInputs;
struct MotionTables;

/// Moves the face by expressions, on the layer `expression`: one at a time, crossfaded into the
/// next; each region of the face begins with a delay, and one side may begin later than the other.
/// Also by the emotions of the list of units (Face.31 and on), on the layer `emotions`, each
/// independently of the others. Gives the signal `expression`: how strongly either is shown.
/// Lifetime: the inputs given to the constructor outlive this. Commands come in order of time.
/// Errors: kBadValue listing what exists.
class ExpressionMotion : public MotionSource {
 public:
  explicit ExpressionMotion(const MotionInputs& in);

  /// Shows an expression. If `duration` is not zero, the face is neutral again that long after
  /// `now`; onset and offset of a short expression take half of it each.
  vm::Result<void> Show(vm::Time now, std::string_view name, int pattern, double strength,
                        vm::Time duration);
  /// Shows the expression at a point of the emotion space, reached within `move`, by default within
  /// the usual onset of expressions.
  void ShowSpacePoint(vm::Time now, const EmotionSpace::Point& point, std::optional<vm::Time> move);
  void Neutral(vm::Time now);
  /// Moves an emotion to `strength`. REQUIRES: FaceSlot `index` is an emotion.
  void SetEmotion(vm::Time now, std::size_t index, double strength);
  /// Sets the delay of one side of the face, 20 to 40 ms, which is always the same for a `person`.
  /// (How much weaker one side is belongs to the head.)
  void SetPerson(std::uint64_t person) { DrawLags(Scramble(seed_ ^ person)); }

  void Contribute(vm::Time t, MotionLayers& layers) const override;
  vm::Time SettledAt(vm::Time t) const override;
  vm::Time EndsAt(vm::Time t) const override { return end_.value_or(t); }

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  void DrawLags(std::uint64_t seed);
  vm::Time OnsetOf(const Expression& expression) const;
  void Plan(vm::Time now, const FaceLook& look, const Expression::Timing& timing, vm::Time onset,
            vm::Time duration);

  const MotionTables& tables_;
  const ExpressionTable& expressions_;
  const MotionSettings& settings_;
  const IdleSwitches& switches_;
  std::uint64_t seed_;
  Sided<double> side_lags_ms_;
  // By region; of each only the units of its side are used.
  Sided<std::array<Track<FaceLook>, kRegions>> regions_;
  Track<float> shown_;                  // how strongly an expression is shown, 0..1
  std::vector<Track<float>> emotions_;  // indexed as the face slots
  vm::Time onset_end_{0};
  std::optional<vm::Time> end_;  // of an expression with a duration
};

}  // namespace fsm
