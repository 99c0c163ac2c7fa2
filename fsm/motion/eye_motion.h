#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "embedded/gesture_numbers.h"
#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/inputs/motion_patterns.h"
#include "fsm/motion/inputs/motion_settings.h"

namespace fsm {

class IdleSwitches;
struct MotionInputs;

/// Turns the eyes and blinks on command, on the layer `eyes`. Gives the signal `at_user`, 0..1: how
/// far the eyes are held on the viewer. Lifetime: the inputs given to the constructor outlive
/// this.
class EyeMotion : public MotionSource {
 public:
  explicit EyeMotion(const MotionInputs& in);

  /// Turns the eyes of those sides to `angles`. If `duration` is not zero, they are back at rest
  /// after it.
  void Rotate(vm::Time now, const Sided<bool>& sides, const EyeAngles& angles, vm::Time duration);
  /// Looks in a direction with eyes and head: the eyes jump there, the head follows more slowly
  /// with its share of a large angle, and the eyes turn back by as much.
  void Gaze(vm::Time now, const EyeAngles& angles, vm::Time duration);
  void GazeAtUser(vm::Time now);
  void Think(vm::Time now);
  /// Blinks `count` times in succession. REQUIRES: the pattern, counted from 1, exists.
  void Blink(vm::Time now, std::size_t pattern, int count = 1);
  void StopBlinks() { blinks_.clear(); }

  void Contribute(vm::Time t, MotionLayers& layers) const override;
  std::optional<vm::Time> NextMotion(vm::Time t) const override;
  vm::Time EndsAt(vm::Time t) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  enum class Aim {
    kPlace,
    kUser,
    kThought
  };  // the target of the gaze; kThought: none, while thinking
  void SetAim(vm::Time now, Aim aim, const EyeAngles& angles, vm::Time duration);
  /// Returns the head's share of one angle of a gaze.
  float HeadShareOf(float angle) const;
  /// Returns the mean direction of the eyes while thinking.
  EyeAngles Thinking() const;
  void BlinkAtShift(vm::Time now, const EyeAngles& from, const EyeAngles& to);
  EyeAngles ThinkingAt(vm::Time t) const;
  double BlinkAt(vm::Time t) const;
  vm::Time BlinksEnd(vm::Time t) const;

  struct Blinking {
    BlinkPattern pattern;
    vm::Time start;
  };
  const MotionPatterns& patterns_;
  const MovementNumbers& gestures_;
  const MotionSettings& settings_;
  const IdleSwitches& switches_;
  std::uint64_t seed_;
  Sided<Track<EyeAngles>> rotation_;
  Track<EyeAngles> gaze_;        // of both eyes, relative to the body
  Track<EyeAngles> head_share_;  // of the gaze
  Track<float> on_user_, thinking_, vergence_deg_;
  vm::Time thinking_since_{0};
  std::int64_t shifts_ = 0;  // of the gaze
  std::vector<Blinking> blinks_;
  struct Ends {  // when a turn with a duration will be over; in the past for others
    Sided<vm::Time> rotation;
    vm::Time gaze{0};
  };
  Ends ends_;
};

}  // namespace fsm
