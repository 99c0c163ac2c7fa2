#pragma once

#include <cstdint>
#include <span>

/// Private to srm/engine. What a fit lacks for reasons other than the words, in the engine's units
/// per 10 ms frame. The figures are measured (docs/speech.md).
namespace srm {

/// How far the loud frames of a sound stand above its quiet ones, in dB: 40 in a quiet room, 25
/// with white noise at 20 dB. 0 for less than a frame.
double Clearness(std::span<const std::int16_t> samples);

/// By noise: the grammar's words lose more by it than free phonemes, which fit noise as well.
double NoiseAllowance(double clearness_db);

/// By length: a long phrase that was not said fits far worse than a short one.
double LengthAllowance(int speech_frames);

}  // namespace srm
