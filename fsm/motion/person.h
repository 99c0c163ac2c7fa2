#pragma once

#include <array>
#include <cstdint>

#include "fsm/motion/expression_motion.h"

namespace fsm {

/// How one person's face differs from its mirror image while it moves: one side of each part is a
/// little weaker and begins later, always the same. 3 to 8 % and 20 to 40 ms (research notes on the
/// face, 4.4).
struct Asymmetry {
  std::array<float, kActionUnits> left, right;  ///< factors, one of each pair is 1
  ExpressionMotion::Sides lag_ms{};
};
/// The same for the same seed.
Asymmetry AsymmetryOf(std::uint64_t seed, const UnitList& list);

}  // namespace fsm
