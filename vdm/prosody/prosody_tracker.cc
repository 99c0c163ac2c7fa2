#include "vdm/prosody/prosody_tracker.h"

#include <cmath>
#include <numbers>

namespace vdm {
namespace {

constexpr float kBinHz = 16000.0F / Fourier512::kSize;

/// In dB, of the bins from `low_hz` up to `high_hz`.
float Level(const std::array<float, Fourier512::kBins>& power, float low_hz, float high_hz) {
  float sum = 1;  // silence is 0 dB
  for (auto bin = static_cast<std::size_t>(std::ceil(low_hz / kBinHz));
       static_cast<float>(bin) * kBinHz < high_hz; ++bin) {
    sum += power[bin];
  }
  return 10 * std::log10(sum);
}

}  // namespace

ProsodyTracker::ProsodyTracker() {
  // So scaled that the sum of the bins on one side is the mean square of a sound within them.
  const double squares = 3.0 / 8 * kWindow;
  const double scale = std::sqrt(2 / (squares * Fourier512::kSize));
  for (std::size_t i = 0; i < kWindow; ++i) {
    const double turn = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kWindow;
    window_[i] = static_cast<float>(scale * (0.5 - 0.5 * std::cos(turn)));
  }
}

void ProsodyTracker::Add(std::span<const std::int16_t> samples, std::vector<ProsodyFrame>& frames) {
  framer_.Add(samples, [&](std::span<const std::int16_t> window) {
    std::array<float, kWindow> weighed;
    for (std::size_t i = 0; i < kWindow; ++i) weighed[i] = window_[i] * window[i];
    const auto power = fourier_.Power(weighed);
    const float low = Level(power, 80, 1000), high = Level(power, 1000, 4000);
    levels_.push_back({.power_db = Level(power, 80, 4000),
                       .tilt_db = low - high,
                       .vowel_db = Level(power, 300, 2500)});
  });
  pitches_.clear();
  pitch_.Add(samples, pitches_);
  for (const PitchTracker::Frame& pitch : pitches_) {
    ProsodyFrame frame = levels_.front();
    levels_.pop_front();
    frame.hz = pitch.hz;
    frame.voicing = pitch.voicing;
    frames.push_back(frame);
  }
}

}  // namespace vdm
