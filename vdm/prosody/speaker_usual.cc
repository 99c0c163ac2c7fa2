#include "vdm/prosody/speaker_usual.h"

#include <algorithm>
#include <cmath>

namespace vdm {

void RunningMean::Add(double value) {
  const double keeps = 1 - 1 / prior_.memory;
  const double off = value - mean_;
  weight_ = weight_ * keeps + 1;
  sum_ = sum_ * keeps + value;
  squares_ = squares_ * keeps + off * off;
  mean_ = (sum_ + prior_.mean_weight * prior_.mean) / (weight_ + prior_.mean_weight);
  const double usual = prior_.deviation * prior_.deviation;
  const double square =
      (squares_ + prior_.deviation_weight * usual) / (weight_ + prior_.deviation_weight);
  // Nobody is so even, or so uneven, that it would not be a fault of the measurement.
  deviation_ = std::clamp(std::sqrt(square), 0.3 * prior_.deviation, 3 * prior_.deviation);
}

// Instants are 10 ms apart: a memory of 6000 is a minute of voice. The prior of the pitch is
// between what is usual of men and of women, about 120 and 210 Hz, with a deviation of three
// semitones within a speaker; that of the rate is what SyllableCounter finds in read English.
SpeakerUsual::SpeakerUsual()
    : log_hz({.mean = std::log(160.0),
              .deviation = 0.17,
              .mean_weight = 5,
              .deviation_weight = 100,
              .memory = 6000}),
      power_db(
          {.mean = 60, .deviation = 6, .mean_weight = 1, .deviation_weight = 100, .memory = 6000}),
      tilt_db(
          {.mean = 12, .deviation = 7, .mean_weight = 5, .deviation_weight = 100, .memory = 6000}),
      rate({.mean = 4.5, .deviation = 0.9, .mean_weight = 2, .deviation_weight = 6, .memory = 30}) {
}

}  // namespace vdm
