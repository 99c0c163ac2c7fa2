#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"

namespace sound {

/// Any sound file libsndfile reads, as 16 kHz mono; a file *.raw is 16 kHz 16 bit little endian. At
/// most two hours. Errors: kUnavailable (cannot be read), kBadValue (no sound, a rate out of
/// range), kTooLong.
vm::Result<std::vector<std::int16_t>> ReadSound(const std::string& path);

/// The same for sound that comes bit by bit.
class StreamResampler {
 public:
  /// REQUIRES: 1000 to 400000.
  explicit StreamResampler(unsigned rate_hz);
  ~StreamResampler();
  std::vector<std::int16_t> Add(const std::vector<std::int16_t>& samples);

 private:
  struct State;
  const unsigned rate_hz_;
  std::unique_ptr<State> state_;  // null at our own rate
};

}  // namespace sound
