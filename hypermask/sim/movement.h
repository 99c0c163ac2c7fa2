#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "hypermask/geometry/pinhole.h"

namespace hypermask {

/// How a simulated mask moves: its pose in the world (mm; x right, y down, z away from the
/// projector, which is at 0) as a pure function of time, kind and seed.
class Movement {
 public:
  enum class Kind {
    kStill,
    kPlaces,  ///< stands still at one place after the other, nearer, farther and turned
    kSway,    ///< rocks from side to side, to 0.9 Hz
    kWalk,    ///< walks about, 2 steps a second, nearer and farther
    kShake,   ///< shakes the head, bursts of 1.4 to 2.4 Hz with pauses
    kTurn,    ///< looks elsewhere, to 30 degrees to the sides and 20 up and down, with pauses
  };
  static constexpr double kHoldSeconds = 12;  ///< how long it stands at each of kPlaces

  Movement(Kind kind, std::uint32_t seed) : kind_(kind), seed_(seed) {}
  static std::optional<Kind> Named(std::string_view name);
  static const char* NameOf(Kind kind);
  /// "still, places, sway, walk, shake, turn"
  static std::string Names();

  Pose At(double seconds) const;

 private:
  double Chance(std::uint32_t what, double from, double to) const;
  double Towards(std::uint32_t what, double seconds, double slot, double moving, double least,
                 double most) const;
  const Kind kind_;
  const std::uint32_t seed_;
};

}  // namespace hypermask
