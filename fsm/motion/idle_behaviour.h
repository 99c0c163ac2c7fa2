#pragma once

#include <cstdint>
#include <optional>

#include "embedded/gesture_numbers.h"
#include "fsm/motion/base/motion_source.h"
#include "fsm/motion/base/random_streams.h"
#include "fsm/motion/inputs/motion_patterns.h"
#include "vm_protocol/core/result.h"

namespace fsm {

class IdleSwitches;
struct IdleRun;
struct MotionInputs;

/// Moves the face without commands: small movements of head and eyes, breath and blinks on the
/// layer `idle`, a listener's nods on `nods`, a constant slight expression on `idle_face`.
/// Everything is a function of the switches, the seed and time, so instants may be asked for in any
/// order. Kinds that belong to commands or to speech are shown by other sources. Lifetime: the
/// inputs given to the constructor outlive this.
class IdleBehaviour : public MotionSource {
 public:
  explicit IdleBehaviour(const MotionInputs& in);

  double BlinkAt(vm::Time t) const;
  void Contribute(vm::Time t, MotionLayers& layers) const override;
  std::optional<vm::Time> NextMotion(vm::Time t) const override;
  vm::Time SettledAt(vm::Time t) const override { return t; }

 protected:
  void ForEachTrack(const TrackVisitor& visit) const override;

 private:
  double Random(RandomStream stream, std::int64_t index) const;  // -1..1
  double Wander(std::size_t wave, double periods) const;         // 0..5; smooth, -1..1
  void AddMove(vm::Time t, Angles& out) const;
  double NodAt(const IdleRun& run, vm::Time t) const;  // degrees down
  /// Returns 0 = exhaled .. 1 = inhaled.
  double BreathAt(const AutoBreath& pattern, vm::Time since) const;
  EyeAngles SaccadesAt(const AutoGaze& gaze, vm::Time t) const;
  /// A blink: its number since blinking was switched on, from 0, and when it begins.
  struct Blink {
    std::int64_t index = -1;
    vm::Time start{0};
  };
  /// Returns the time from the start of the previous blink to that of blink `index`; for the first
  /// blink, from switching on.
  vm::Time BlinkInterval(std::size_t pattern, std::int64_t index) const;
  /// Returns the last blink that has begun by `t` with a pattern switched on at `since`; its index
  /// is -1 before the first.
  Blink LastBlink(std::size_t pattern, vm::Time since, vm::Time t) const;

  const MotionPatterns& patterns_;
  const MovementNumbers& gestures_;
  const IdleSwitches& switches_;
  std::uint64_t seed_;
  /// A cache: the blink that was asked for last. A blink begins after the sum of all intervals
  /// before it, and each interval depends on its number only, so a nearby blink, earlier or later,
  /// is found from here in a few steps. The result does not depend on the cache.
  struct BlinkCache {
    vm::Time since{0};  // the run's values for which it holds
    std::size_t pattern = 0;
    Blink blink;
  };
  mutable BlinkCache cache_;
};

}  // namespace fsm
