#pragma once

#include <array>
#include <cstdint>

namespace fsm {

/// One of the agent's own sides; arrays over both sides have this order. The agent's right is on
/// the viewer's left, where x is negative.
enum class Side : std::uint8_t { kRight, kLeft };

inline constexpr std::array kSides{Side::kRight, Side::kLeft};

/// Returns the sign of x on that side.
constexpr float SignOf(Side side) { return side == Side::kRight ? -1.0f : 1.0f; }

/// A value for each side. `Of`: whose sides, an enumeration of kRight and kLeft.
template <typename T, typename Of = Side>
struct Sided {
  T right{}, left{};

  constexpr T& operator[](Of side) { return side == Of::kRight ? right : left; }
  constexpr const T& operator[](Of side) const { return side == Of::kRight ? right : left; }
  /// Returns both values, the right one first.
  constexpr std::array<T, 2> InOrder() const { return {right, left}; }
  friend bool operator==(const Sided&, const Sided&) = default;
};

}  // namespace fsm
