#pragma once

#include <numbers>

namespace fsm {

/// 180 degrees in radians.
inline constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace fsm
