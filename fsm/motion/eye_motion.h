#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fsm/motion/idle_behaviour.h"
#include "fsm/motion/motion_patterns.h"
#include "fsm/motion/motion_settings.h"
#include "fsm/motion/motion_source.h"

namespace fsm {

/// Where the eyes are turned, and blinks on demand, on the layer `eyes`. The signal `at_user` says
/// how far the eyes are kept on the viewer. Lifetime: what it is made with outlives it.
class EyeMotion : public MotionSource {
 public:
  EyeMotion(const MotionPatterns& patterns, const GestureNumbers& gestures,
            const MotionSettings& settings, const IdleBehaviour& idle, std::uint64_t seed)
      : patterns_(patterns), gestures_(gestures), settings_(settings), idle_(idle), seed_(seed) {}

  /// The eyes that are true turn there, and with a `duration` (not zero) are back after it.
  void Turn(vm::Time now, bool left, bool right, const EyeAngles& angles, vm::Time duration);
  /// Looks somewhere with eyes and head: the eyes are there at once, the head takes its share of a
  /// large angle more slowly and the eyes give it back meanwhile.
  void Gaze(vm::Time now, const EyeAngles& angles, vm::Time duration);
  void LookAtUser(vm::Time now);
  void Think(vm::Time now);
  /// `count` blinks, one after the other. REQUIRES: the pattern exists; counted from 1.
  void Blink(vm::Time now, std::size_t pattern, int count = 1);
  void StopBlinks() { blinks_.clear(); }

  void Contribute(vm::Time t, MotionLayers& layers) const override;
  std::optional<vm::Time> NextActivity(vm::Time t) const override;
  vm::Time FiniteEnd(vm::Time t) const override;

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  enum class Aim { kPlace, kUser, kNothing };  // of the gaze; a thinker looks at nothing
  void LookAt(vm::Time now, Aim aim, const EyeAngles& angles, vm::Time duration);
  /// What the head turns of a gaze, by one angle.
  float HeadShareOf(float angle) const;
  /// About where a thinker looks.
  EyeAngles Thinking() const;
  void BlinkAtShift(vm::Time now, const EyeAngles& from, const EyeAngles& to);
  EyeAngles ThinkingAt(vm::Time t) const;
  double LidsShutAt(vm::Time t) const;
  vm::Time BlinksEnd(vm::Time t) const;

  struct Blinking {
    BlinkPattern pattern;
    vm::Time start;
  };
  const MotionPatterns& patterns_;
  const GestureNumbers& gestures_;
  const MotionSettings& settings_;
  const IdleBehaviour& idle_;
  std::uint64_t seed_;
  Sided<Track<EyeAngles>> turned_;
  Track<EyeAngles> gaze_;        // both eyes, in space
  Track<EyeAngles> head_share_;  // of the gaze
  Track<float> on_user_, thinking_, vergence_deg_;
  vm::Time thinking_since_{0};
  std::int64_t shifts_ = 0;  // of the gaze
  std::vector<Blinking> blinks_;
  struct Ends {  // when what is turned will be home; past where it is not timed
    Sided<vm::Time> turned;
    vm::Time gaze{0};
  };
  Ends ends_;
};

}  // namespace fsm
