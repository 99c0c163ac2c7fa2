#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/inputs/motion_patterns.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Turns the head, on the layer `head`: to a commanded direction, to which movements (nods) are
/// added. Lifetime: `patterns` outlives this.
class HeadMotion : public MotionSource {
 public:
  explicit HeadMotion(const MotionPatterns& patterns) : patterns_(patterns) {}

  void TurnTo(vm::Time now, const Angles& angles);
  /// Turns by `angles` from the target of the last turn; each angle is clamped to +-90 degrees.
  void TurnBy(vm::Time now, const Angles& angles);
  /// Plays a movement `count` times, each time 15 % smaller; `strength` multiplies its angles. It
  /// replaces the current movement, which fades out within 80 ms. Error: kBadValue for an unknown
  /// pattern.
  vm::Result<void> Play(vm::Time now, std::string_view kind, int pattern, double strength,
                        int count);
  void StopMovements(vm::Time now);

  void Contribute(vm::Time t, MotionLayers& layers) const override;
  std::optional<vm::Time> NextMotion(vm::Time t) const override;
  vm::Time EndsAt(vm::Time t) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override { visit(turn_); }

 private:
  struct Movement {
    const HeadCurve* curve;
    double strength;
    int count;
    vm::Time start;
    std::optional<vm::Time> stopped;
  };
  static vm::Time EndOf(const Movement& movement);

  const MotionPatterns& patterns_;
  Track<Angles> turn_;
  std::vector<Movement> movements_;
};

}  // namespace fsm
