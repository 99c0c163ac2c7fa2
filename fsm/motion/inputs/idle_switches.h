#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

#include "fsm/motion/base/track.h"
#include "fsm/motion/inputs/motion_patterns.h"

namespace fsm {

/// A pattern of a kind of idle behaviour that is on, or fades in or out.
struct IdleRun {
  std::size_t pattern = 0;  ///< from 1
  vm::Time since{0};        ///< when it was switched on
  float weight = 0;         ///< how far it has faded in, 0..1
};
/// The weights of a kind's runs are at most 1 together.
using IdleRuns = std::vector<IdleRun>;
IdleRuns Mix(const IdleRuns& a, const IdleRuns& b, double share_of_b);

/// Says which kinds of idle behaviour are on, and by which pattern. A pattern that replaces another
/// fades in while that fades out. Commands change it; the sources that show a kind, or take it into
/// account, read it.
/// Lifetime: `patterns` outlives this. Errors: kBadValue listing what exists.
class IdleSwitches {
 public:
  struct Switch {
    std::size_t pattern = 0;  ///< from 1; 0 = off
    vm::Time since{0};        ///< when it was switched on
    Track<IdleRuns> runs;

    bool on() const { return pattern > 0; }
  };

  /// Switches ASYMMETRY on and everything else off.
  explicit IdleSwitches(const MotionPatterns& patterns);
  /// Switches a kind, given by name, to a pattern; 0 switches it off.
  vm::Result<void> Set(vm::Time now, std::string_view kind, int pattern);
  /// Switches all kinds as a profile says; OFF restores the state after construction.
  vm::Result<void> SetProfile(vm::Time now, std::string_view profile);

  const Switch& operator[](IdleKind kind) const {
    return switches_[static_cast<std::size_t>(kind)];
  }
  const std::array<Switch, kIdleKindCount>& all() const { return switches_; }

 private:
  void Set(vm::Time now, IdleKind kind, std::size_t pattern);

  const MotionPatterns& patterns_;
  std::array<Switch, kIdleKindCount> switches_;  // by IdleKind
};

}  // namespace fsm
