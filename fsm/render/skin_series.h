#pragma once

#include <cstdint>

#include "fsm/base/random.h"

namespace fsm {

/// The series of random numbers by which the renderer paints skin, one for each property. The
/// numbers stay, as all pictures depend on them.
enum class SkinSeries : std::uint64_t {
  kBroadPatches = 1,
  kFinePatches = 2,
  kPoreX = 11,
  kPoreY = 12,
  kPoreDark = 13,
  kPoreRadius = 14,
  kCoarseGrain = 15,
  kFineGrain = 16,
  kLipLine = 17,
  kFreckleX = 21,
  kFreckleY = 22,
  kFreckleThin = 23,
  kFreckleStrength = 24,
  kFreckleRadius = 25,
  kVesselX = 31,
  kVesselY = 32,
  kVesselWay = 33,
  kVesselBend = 34
};

/// Returns the i-th number of a series, in 0..1.
inline float Chance(SkinSeries series, std::uint64_t i) {
  return Chance(static_cast<std::uint64_t>(series), i);
}

}  // namespace fsm
