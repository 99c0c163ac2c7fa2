#pragma once

#include <cstdint>
#include <string_view>

namespace fsm {

// These numbers depend on their arguments only and are the same on every machine, so films repeat
// and any instant can be evaluated in any order. Pure; thread: any.

/// The FNV-1a hash of a text (Fowler, Noll and Vo). Unlike std::hash it is the same everywhere.
constexpr std::uint64_t HashOf(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

/// The finalizer of SplitMix64 (Steele, Lea and Flood 2014): each input bit affects all the result.
inline std::uint64_t Scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Returns a pseudo-random number in -1..1. Different `stream`s are independent of each other.
inline double RandomAt(std::uint64_t seed, std::uint64_t stream, std::int64_t index) {
  const std::uint64_t bits =
      Scramble(Scramble(seed * 1024 + stream) ^ static_cast<std::uint64_t>(index));
  return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

/// Returns the i-th pseudo-random number of a series, in 0..1.
inline float Chance(std::uint64_t series, std::uint64_t i) {
  return static_cast<float>(Scramble(series << 40 ^ i) >> 40) * 0x1p-24f;
}

/// Returns the noise at the lattice point (i, j), in -1..1. It has a hash of its own only because
/// the pictures of all heads depend on it.
inline float NoiseAt(int i, int j) {
  std::uint32_t h =
      static_cast<std::uint32_t>(i) * 0x9E3779B1u ^ static_cast<std::uint32_t>(j) * 0x85EBCA77u;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 13;
  return static_cast<float>(h & 0xFFFFu) / 32767.5f - 1.0f;
}

}  // namespace fsm
