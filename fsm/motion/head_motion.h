#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "fsm/motion/motion_patterns.h"
#include "fsm/motion/motion_source.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// Where the head is turned, on the layer `head`: a direction it was told, and movements (nods)
/// added to it. The patterns outlive it.
class HeadMotion : public MotionSource {
 public:
  explicit HeadMotion(const MotionPatterns& patterns) : patterns_(patterns) {}

  void TurnTo(vm::Time now, const Angles& angles);
  /// From where the last turn leads; each angle stays within +-90 degrees.
  void TurnBy(vm::Time now, const Angles& angles);
  /// A movement `count` times, each time 15 % smaller; `strength` multiplies its angles. It takes
  /// the place of the one in hand, which fades within 80 ms. kBadValue for a pattern there is not.
  vm::Result<void> Play(vm::Time now, std::string_view kind, int pattern, double strength,
                        int count);
  void StopMoves(vm::Time now);

  void Contribute(vm::Time t, MotionLayers& layers) const override;
  std::optional<vm::Time> NextActivity(vm::Time t) const override;
  vm::Time FiniteEnd(vm::Time t) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override { visit(turn_); }

 private:
  struct Move {
    const HeadCurve* curve;
    double strength;
    int count;
    vm::Time start;
    std::optional<vm::Time> stopped;
  };
  static vm::Time EndOf(const Move& move);

  const MotionPatterns& patterns_;
  Track<Angles> turn_;
  std::vector<Move> moves_;
};

}  // namespace fsm
