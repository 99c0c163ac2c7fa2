#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "vm_protocol/core/result.h"

namespace filmdub {

/// Pictures a second of a film: the usual distance of its pictures in time. REQUIRES: two or more,
/// in order, milliseconds.
double PicturesPerSecond(std::span<const double> times_ms);

/// How much faster or slower a film may be shown so that it lasts as long as its new sound.
inline constexpr double kMostStretch = 2;

/// Which picture of the film each picture of the new one shows: as many as `sound_s` needs at
/// `rate`. All of the film is shown, evenly: pictures are held where it is shorter than the sound
/// and dropped where it is longer. Error: kBadValue where that would take more than kMostStretch.
vm::Result<std::vector<std::size_t>> FitLength(std::span<const double> times_ms, double rate,
                                               double sound_s);

}  // namespace filmdub
