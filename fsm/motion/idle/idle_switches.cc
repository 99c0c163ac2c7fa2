#include "fsm/motion/idle/idle_switches.h"

#include <algorithm>
#include <ranges>

#include "fsm/motion/idle/idle_kinds.h"
#include "fsm/motion/motion_errors.h"

namespace fsm {

IdleSwitches::IdleSwitches(const MotionPatterns& patterns) : patterns_(patterns) {
  switches_[static_cast<std::size_t>(IdleKind::kAsymmetry)] = {1, true, vm::Time(0), Track(1.0f)};
}

void IdleSwitches::Set(vm::Time now, IdleKind kind, std::size_t pattern) {
  Switch& own = switches_[static_cast<std::size_t>(kind)];
  if (pattern > 0) {
    own.pattern = pattern;
    own.since = now;
  }
  own.on = pattern > 0;
  own.weight.MoveTo(now, own.on ? 1.0f : 0.0f, RowOf(kind).fade);
}

vm::Result<void> IdleSwitches::Set(vm::Time now, std::string_view kind, int pattern) {
  const auto named = IdleKindNamed(kind);
  if (!named) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("'{}' is nothing the face does by itself; {} expected", kind,
                    fmt::join(IdleKinds() | std::views::transform(&IdleKindRow::name), " ")));
  }
  if (pattern != 0) {
    const std::size_t count = RowOf(*named).count(patterns_);
    if (auto fits = CheckPatternNumber(kind, pattern, 0, count); !fits) return fits;
  }
  Set(now, *named, static_cast<std::size_t>(pattern));
  return {};
}

vm::Result<void> IdleSwitches::SetProfile(vm::Time now, std::string_view profile) {
  IdleProfile wanted{};
  if (profile == "OFF") {
    wanted[static_cast<std::size_t>(IdleKind::kAsymmetry)] = 1;
  } else {
    const auto found = patterns_.profiles.find(profile);
    if (found == patterns_.profiles.end()) {
      return vm::Fail(vm::Errc::kBadValue, fmt::format("'{}' is no way to live; {} or OFF expected",
                                                       profile, KeysOf(patterns_.profiles)));
    }
    wanted = found->second;
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const auto kind = static_cast<IdleKind>(i);
    // A configuration of the original may have fewer patterns than the tables of the profiles.
    const std::size_t pattern = std::min(wanted[i], RowOf(kind).count(patterns_));
    if (pattern != ((*this)[kind].on ? (*this)[kind].pattern : 0)) Set(now, kind, pattern);
  }
  return {};
}

}  // namespace fsm
