#pragma once

#include <cstdint>
#include <optional>

#include "fsm/motion/eye_motion.h"
#include "fsm/motion/motion_table.h"

namespace fsm {

/// What a face does by itself: blinks, small movements of head and eyes. Everything is a function
/// of the seed and the time, with no state but what is switched on, so any instant can be asked for
/// in any order. The table outlives it.
class Autonomy {
 public:
  Autonomy(const MotionTable& table, std::uint64_t seed) : table_(table), seed_(seed) {}

  /// Pattern 0 switches off. REQUIRES: pattern at most the count the table has.
  void Blink(vm::Time now, std::size_t pattern);
  void Move(vm::Time now, std::size_t pattern);
  void Gaze(vm::Time now, std::size_t pattern);
  void Userdef(vm::Time now, std::size_t pattern);
  /// Patterns of MOVE: the files', if the configuration named any, else our own.
  static std::size_t MovePatterns(const MotionTable& table);

  Angles HeadAt(vm::Time t) const;
  EyeAngles EyesAt(vm::Time t) const;
  double LidsShutAt(vm::Time t) const;
  std::optional<vm::Time> NextActivity(vm::Time t) const;

 private:
  struct Switch {
    std::size_t pattern = 0;  // the last one that was on
    bool on = false;
    vm::Time since{0};
    Track<float> weight;
    void Set(vm::Time now, std::size_t wanted, vm::Time fade);
  };
  double Random(std::uint64_t stream, std::int64_t index) const;  // -1..1
  double Wander(std::uint64_t stream, double periods) const;      // smooth, -1..1
  vm::Time BlinkStart(std::int64_t index) const;

  const MotionTable& table_;
  std::uint64_t seed_;
  Switch blink_, move_, gaze_, userdef_;
};

}  // namespace fsm
