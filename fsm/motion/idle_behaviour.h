#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "embedded/gesture_numbers.h"
#include "fsm/motion/motion_patterns.h"
#include "fsm/motion/motion_source.h"
#include "fsm/motion/random_streams.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// What a face does by itself: small movements of head and eyes, breath and blinks on the layer
/// `idle`, a listener's nods on `nods`, a slight look that stays on `idle_face`. Everything is a
/// function of the seed and the time, with no state but what is switched on, so any instant can be
/// asked for in any order. The kinds that belong to commands or to speech are only switched here;
/// other sources ask for them. The patterns outlive it. Errors: kBadValue with what there is.
class IdleBehaviour : public MotionSource {
 public:
  /// ASYMMETRY is on, everything else is off.
  IdleBehaviour(const MotionPatterns& patterns, const GestureNumbers& gestures, std::uint64_t seed);

  /// A kind by its name; pattern 0 switches off.
  vm::Result<void> Set(vm::Time now, std::string_view kind, int pattern);
  /// Everything as a profile says; OFF is as it is at the start.
  vm::Result<void> SetProfile(vm::Time now, std::string_view profile);
  /// Pattern 0 switches off. REQUIRES: pattern at most MotionPatterns::Count.
  void Set(vm::Time now, IdleKind kind, std::size_t pattern);
  bool On(IdleKind kind) const { return Of(kind).on; }
  /// The pattern in force or switched off last, from 1; 0 = never on.
  std::size_t Pattern(IdleKind kind) const { return Of(kind).pattern; }
  /// 0..1 while it is switched.
  double Weight(IdleKind kind, vm::Time t) const { return Of(kind).weight.At(t); }

  double LidsShutAt(vm::Time t) const;
  void Contribute(vm::Time t, MotionLayers& layers) const override;
  std::optional<vm::Time> NextActivity(vm::Time t) const override;
  vm::Time SettledAt(vm::Time t) const override { return t; }

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  struct Switch {
    std::size_t pattern = 0;
    bool on = false;
    vm::Time since{0};
    Track<float> weight;
  };
  const Switch& Of(IdleKind kind) const { return switches_[static_cast<std::size_t>(kind)]; }
  double Random(RandomStream stream, std::int64_t index) const;  // -1..1
  double Wander(std::size_t wave, double periods) const;         // 0..5; smooth, -1..1
  void AddMove(vm::Time t, Angles& out) const;
  void AddNods(vm::Time t, Angles& out) const;
  double BreathAt(vm::Time t) const;  // 0 = out, 1 = in; times the switch's weight
  EyeAngles EyesAt(vm::Time t) const;
  /// A blink since the switch: its number, from 0, and when it begins.
  struct Blink {
    std::int64_t index = -1;
    vm::Time start{0};
  };
  /// From the beginning of the blink before to that of blink `index`; of the first, from the
  /// switch.
  vm::Time BlinkInterval(std::int64_t index) const;
  /// The last blink that has begun by `t`; its index is -1 before the first.
  Blink LastBlink(vm::Time t) const;

  const MotionPatterns& patterns_;
  const GestureNumbers& gestures_;
  std::uint64_t seed_;
  std::array<Switch, kIdleKindCount> switches_;
  /// The blink that was asked for last. A blink's place is the sum of all intervals before it, but
  /// each interval follows from its number alone: from here the next one asked for, before or
  /// after, is a few steps away. What is found does not depend on where this stands.
  mutable Blink blink_;
};

}  // namespace fsm
