#pragma once

#include <cstdint>

#include "fsm/base/random.h"

namespace fsm {

/// Independent streams of pseudo-random numbers from one seed, one for each quantity that varies.
/// Changing a value would change the behaviour of existing seeds.
enum class RandomStream : std::uint64_t {
  // IdleBehaviour
  kBlinkTime = 0,
  kBlinkDepth = 1,
  kGazeTime = 2,
  kGazeX = 3,
  kGazeY = 4,
  kNodTime = 5,
  kNodSize = 6,
  kHeadWander = 10,  // and the five that follow
  // EyeMotion
  kThinkTime = 7,
  kThinkSide = 8,
  kThinkHeight = 9,
  kShiftBlink = 300,
  // SpeechGestures
  kTurn = 100,
  kTilt = 101,
  kLift = 102,
  kBrow = 103,
  kAvertSide = 104,
  kAvertLength = 105,
  // ExpressionMotion
  kLateSide = 200,
  kLag = 201,
  // SpeechMotion
  kEndBlink = 310,
  kEndBlinkTime = 311,
  kAvertBlink = 312
};

/// Returns element `index` of a stream, in -1..1.
inline double RandomAt(std::uint64_t seed, RandomStream stream, std::int64_t index) {
  return RandomAt(seed, static_cast<std::uint64_t>(stream), index);
}

}  // namespace fsm
