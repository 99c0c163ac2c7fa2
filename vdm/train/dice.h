#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace vdm {

/// Pseudo-random numbers (SplitMix64: Steele, Lea and Flood, Fast splittable pseudorandom number
/// generators, 2014). The same seed gives the same numbers on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed) {}
  /// Of its own for the n-th thing: what one draws does not change what another draws.
  Dice For(std::uint64_t n) const {
    Dice other(state_ ^ ((n + 1) * 0xD1B54A32D192ED03U));
    other.Next();
    return other;
  }
  std::uint64_t Next() {
    state_ += 0x9E3779B97F4A7C15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }
  double Uniform() { return static_cast<double>(Next() >> 11) * 0x1p-53; }  ///< 0 .. 1
  double Between(double low, double high) { return low + (high - low) * Uniform(); }
  bool Chance(double p) { return Uniform() < p; }
  std::size_t Below(std::size_t n) { return static_cast<std::size_t>(Next() % n); }
  /// Mean 0, deviation 1 (Box and Muller).
  double Normal() {
    const double u = 1 - Uniform();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * Uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace vdm
