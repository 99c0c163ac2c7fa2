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

/// Moves the face without commands: small movements of head and eyes, breath and blinks on the
/// layer `idle`, a listener's nods on `nods`, a constant slight expression on `idle_face`.
/// Everything is a function of seed and time; the only state is which kinds are on. Instants may
/// therefore be asked for in any order. Kinds that belong to commands or to speech are only
/// switched here; other sources query them. Lifetime: the references given to the constructor
/// outlive this. Errors: kBadValue listing what exists.
class IdleBehaviour : public MotionSource {
 public:
  /// Switches ASYMMETRY on and everything else off.
  IdleBehaviour(const MotionPatterns& patterns, const GestureNumbers& gestures, std::uint64_t seed);

  /// Switches a kind, given by name, to a pattern; 0 switches it off.
  vm::Result<void> Set(vm::Time now, std::string_view kind, int pattern);
  /// Switches all kinds as a profile says; OFF restores the state after construction.
  vm::Result<void> SetProfile(vm::Time now, std::string_view profile);
  /// Switches a kind to a pattern; 0 switches it off. REQUIRES: `pattern` is at most
  /// IdleKindRow::count.
  void Set(vm::Time now, IdleKind kind, std::size_t pattern);
  bool On(IdleKind kind) const { return Of(kind).on; }
  /// Returns the current pattern, or the last one if the kind is off, from 1; 0 = never on.
  std::size_t Pattern(IdleKind kind) const { return Of(kind).pattern; }
  /// Returns how far a kind has faded in, 0..1.
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
  // 0 = exhaled, 1 = inhaled; multiplied by the weight of the switch.
  double BreathAt(vm::Time t) const;
  EyeAngles EyesAt(vm::Time t) const;
  /// A blink: its number since blinking was switched on, from 0, and when it begins.
  struct Blink {
    std::int64_t index = -1;
    vm::Time start{0};
  };
  /// Returns the time from the start of the previous blink to that of blink `index`; for the first
  /// blink, from switching on.
  vm::Time BlinkInterval(std::int64_t index) const;
  /// Returns the last blink that has begun by `t`; its index is -1 before the first.
  Blink LastBlink(vm::Time t) const;

  const MotionPatterns& patterns_;
  const GestureNumbers& gestures_;
  std::uint64_t seed_;
  std::array<Switch, kIdleKindCount> switches_;
  /// A cache: the blink that was asked for last. A blink begins after the sum of all intervals
  /// before it, and each interval depends on its number only, so a nearby blink, earlier or later,
  /// is found from here in a few steps. The result does not depend on the cache.
  mutable Blink blink_;
};

}  // namespace fsm
