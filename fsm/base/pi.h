#pragma once

#include <numbers>

namespace fsm {

/// Half a turn in radians.
inline constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace fsm
