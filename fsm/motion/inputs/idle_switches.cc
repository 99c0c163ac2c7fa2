#include "fsm/motion/inputs/idle_switches.h"

#include <algorithm>
#include <ranges>

#include "fsm/motion/base/motion_errors.h"
#include "fsm/motion/inputs/idle_kinds.h"

namespace fsm {

IdleRuns Mix(const IdleRuns& a, const IdleRuns& b, double share_of_b) {
  IdleRuns out;
  const auto add = [&](const IdleRuns& runs, double share) {
    for (const IdleRun& run : runs) {
      const auto weight = static_cast<float>(run.weight * share);
      if (weight <= 0) continue;
      const auto same = std::ranges::find_if(out, [&](const IdleRun& other) {
        return other.pattern == run.pattern && other.since == run.since;
      });
      if (same == out.end()) {
        out.push_back({run.pattern, run.since, weight});
      } else {
        same->weight += weight;
      }
    }
  };
  add(a, 1 - share_of_b);
  add(b, share_of_b);
  return out;
}

IdleSwitches::IdleSwitches(const MotionPatterns& patterns) : patterns_(patterns) {
  Set(vm::Time(0), IdleKind::kAsymmetry, 1);
}

void IdleSwitches::Set(vm::Time now, IdleKind kind, std::size_t pattern) {
  Switch& own = switches_[static_cast<std::size_t>(kind)];
  own.pattern = pattern;
  own.since = now;
  own.runs.MoveTo(now, own.on() ? IdleRuns{{pattern, now, 1}} : IdleRuns{}, RowOf(kind).fade);
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
    if (pattern != (*this)[kind].pattern) Set(now, kind, pattern);
  }
  return {};
}

}  // namespace fsm
