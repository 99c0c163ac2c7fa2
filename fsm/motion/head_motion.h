#pragma once

#include <optional>
#include <vector>

#include "fsm/motion/motion_table.h"
#include "fsm/motion/track.h"

namespace fsm {

/// Where the head is turned: a direction it was told, and movements (nods) added to it.
class HeadMotion {
 public:
  void TurnTo(vm::Time now, const Angles& angles, vm::Time duration);
  /// From where the last turn leads; each angle stays within +-90 degrees.
  void TurnBy(vm::Time now, const Angles& angles, vm::Time duration);
  Angles TargetAt(vm::Time t) const { return turn_.TargetAt(t); }
  /// A movement once. It takes the place of the one in hand, which fades within 80 ms. The curve
  /// outlives the motion.
  /// `strength` multiplies its angles (1 = as it is); played `count` times, each time 15 % smaller.
  void Play(vm::Time now, const HeadCurve& curve, double strength = 1, int count = 1);
  void StopMoves(vm::Time now);

  Angles At(vm::Time t) const;
  vm::Time SettledAt(vm::Time t) const { return turn_.SettledAt(t); }
  std::optional<vm::Time> NextActivity(vm::Time t) const;
  /// When the movements in hand will be over; `t` if they are.
  vm::Time MovesEnd(vm::Time t) const;

 private:
  struct Move {
    const HeadCurve* curve;
    double strength;
    int count;
    vm::Time start;
    std::optional<vm::Time> stopped;
  };
  static vm::Time EndOf(const Move& move);

  Track<Angles> turn_;
  std::vector<Move> moves_;
};

}  // namespace fsm
