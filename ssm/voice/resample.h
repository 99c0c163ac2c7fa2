#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace ssm {

/// Sound at another rate, by a windowed sinc (32 zero crossings to each side at the lower rate,
/// Blackman window): what lies above half the lower rate is damped by more than 60 dB.
/// Frame 0 stays at instant 0; the length is the input's, rounded down. Pure.
/// REQUIRES: both rates from 1000 to 400000.
std::vector<std::int16_t> Resample(std::span<const std::int16_t> samples, std::int64_t from_hz,
                                   std::int64_t to_hz);

}  // namespace ssm
