#pragma once

#include <cstdint>

#include "fsm/motion/expression_motion.h"

namespace fsm {

/// By how much one side of a person's face begins an expression later than the other, always the
/// same: 20 to 40 ms (research notes on the face, 4.4). How much weaker one side is belongs to the
/// head. The same for the same seed.
ExpressionMotion::Sides SideLagsOf(std::uint64_t seed);

}  // namespace fsm
