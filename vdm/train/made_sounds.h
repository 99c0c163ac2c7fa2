#pragma once

#include <vector>

#include "vdm/train/dice.h"

namespace vdm {

/// Sounds that are no speech, 16 kHz, made by chance; about 1 in root mean square.
/// Noise whose spectrum falls or rises by chance, with hum of the mains and knocks now and then.
std::vector<float> MakeNoise(std::size_t samples, Dice& dice);
/// Chords and a tune of two instruments with overtones, with or without a beat.
std::vector<float> MakeMusic(std::size_t samples, Dice& dice);

}  // namespace vdm
