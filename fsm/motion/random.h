#pragma once

#include <cstdint>

namespace fsm {

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): every bit of the input matters.
inline std::uint64_t Scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// A number in -1..1 that depends on nothing but these three: films repeat, and any instant can be
/// asked for in any order. `stream` keeps things that vary apart.
inline double RandomAt(std::uint64_t seed, std::uint64_t stream, std::int64_t index) {
  const std::uint64_t bits =
      Scramble(Scramble(seed * 1024 + stream) ^ static_cast<std::uint64_t>(index));
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

}  // namespace fsm
