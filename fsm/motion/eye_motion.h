#pragma once

#include <array>
#include <optional>
#include <vector>

#include "fsm/motion/motion_table.h"
#include "fsm/motion/track.h"

namespace fsm {

using EyeAngles = std::array<float, 2>;  ///< degrees: down, to the viewer's right

/// How far lids are shut `since` after a blink of that pattern began, 0..1.
double LidsAt(const BlinkPattern& pattern, vm::Time since);
vm::Time LengthOf(const BlinkPattern& pattern);

/// Where the eyes are turned, and blinks on demand.
class EyeMotion {
 public:
  /// The eyes that are true turn there within `move`, and with a `duration` (not zero) are back
  /// after it.
  void Turn(vm::Time now, bool left, bool right, const EyeAngles& angles, vm::Time move,
            vm::Time duration);
  /// Looks somewhere with eyes and head: the eyes are there at once, the head takes its share of a
  /// large angle more slowly and the eyes give it back meanwhile.
  void Gaze(vm::Time now, const EyeAngles& angles, vm::Time move, vm::Time duration);
  void Blink(vm::Time now, const BlinkPattern& pattern);
  void StopBlinks() { blinks_.clear(); }

  EyeAngles LeftAt(vm::Time t) const;
  EyeAngles RightAt(vm::Time t) const;
  /// Where the gaze leads that was told last.
  EyeAngles GazeTarget(vm::Time t) const { return gaze_.TargetAt(t); }
  EyeAngles HeadShareAt(vm::Time t) const { return head_share_.At(t); }
  double LidsShutAt(vm::Time t) const;
  vm::Time SettledAt(vm::Time t) const;
  std::optional<vm::Time> NextActivity(vm::Time t) const;
  vm::Time BlinksEnd(vm::Time t) const;
  /// When a timed turn will be back; none if it holds.
  std::optional<vm::Time> End() const { return end_; }

 private:
  struct Blinking {
    BlinkPattern pattern;
    vm::Time start;
  };
  Track<EyeAngles> left_;
  Track<EyeAngles> right_;
  Track<EyeAngles> gaze_;        // both eyes, in space
  Track<EyeAngles> head_share_;  // of the gaze
  std::vector<Blinking> blinks_;
  std::optional<vm::Time> end_;
};

}  // namespace fsm
