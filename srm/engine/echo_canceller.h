#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

#include "srm/engine/decoder.h"

namespace srm {

/// Takes the agent's own voice out of what the microphone hears, by the adaptive filter of speexdsp
/// and its suppression of what is left. The two must run at one pace; the echo may come up to
/// kTail after the voice. Takes some seconds of voice to learn a room.
/// Thread: one. 16 kHz mono.
class EchoCanceller {
 public:
  static constexpr Millis kTail{256};
  EchoCanceller();
  ~EchoCanceller();
  /// The agent's voice, as it is played; before the microphone's sound of the same time. What is
  /// more than two seconds ahead is dropped.
  void Play(std::span<const std::int16_t> voice);
  /// What the microphone heard, without the voice; in whole frames of 16 ms, the rest comes with
  /// the next call. Where no voice was played it is the microphone's sound.
  std::vector<std::int16_t> Clean(std::span<const std::int16_t> heard);

 private:
  struct State;
  std::unique_ptr<State> state_;
  std::deque<std::int16_t> voice_;
  std::deque<std::int16_t> heard_;
};

}  // namespace srm
