#include "fsm/motion/person.h"

#include "fsm/motion/random.h"

namespace fsm {
namespace {
enum Stream : std::uint64_t { kSide = 200, kWeakness, kLateSide, kLag };
}

Asymmetry AsymmetryOf(std::uint64_t seed, const UnitList& list) {
  Asymmetry out;
  out.left.fill(1);
  out.right.fill(1);
  for (std::size_t unit = 0; unit < kActionUnits; ++unit) {
    const auto region = static_cast<std::int64_t>(list.region[unit]);
    const double weakness =
        0.055 + 0.025 * RandomAt(seed, kWeakness, static_cast<std::int64_t>(unit));
    auto& side = RandomAt(seed, kSide, region) < 0 ? out.left : out.right;
    side[unit] = static_cast<float>(1 - weakness);
  }
  out.lag_ms[RandomAt(seed, kLateSide, 0) < 0 ? 0 : 1] = 30 + 10 * RandomAt(seed, kLag, 0);
  return out;
}

}  // namespace fsm
