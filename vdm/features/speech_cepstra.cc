#include "vdm/features/speech_cepstra.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace vdm {
namespace {

constexpr double kLowHz = 130, kHighHz = 6800, kBinHz = 16000.0 / Fourier512::kSize;
constexpr float kPreEmphasis = 0.97F;
// Power of a noise of about one step of 16 bits in a filter. Sphinx adds such noise to the sound
// where it may be exactly zero, which no recording it learned from was.
constexpr float kLeast = 10;
constexpr double kLifter = 22;

double MelOf(double hz) { return 2595 * std::log10(1 + hz / 700); }
double HzOf(double mel) { return 700 * (std::pow(10, mel / 2595) - 1); }

}  // namespace

SpeechCepstra::SpeechCepstra(float warp) {
  constexpr double kPi = std::numbers::pi;
  for (std::size_t i = 0; i < kWindow; ++i) {
    window_[i] = static_cast<float>(
        0.54 - 0.46 * std::cos(2 * kPi * static_cast<double>(i) / (kWindow - 1)));
  }
  const double low = MelOf(kLowHz), step = (MelOf(kHighHz) - low) / (kFilters + 1);
  for (std::size_t f = 0; f < kFilters; ++f) {
    const auto edge = [&](std::size_t i) {
      const double hz = HzOf(low + step * static_cast<double>(f + i)) * static_cast<double>(warp);
      return std::floor(std::min(hz, 7950.0) / kBinHz + 0.5);
    };
    const double left = edge(0), middle = edge(1), right = std::max(edge(2), edge(1) + 1);
    Filter& filter = filters_[f];
    filter.first = static_cast<std::size_t>(left);
    for (double bin = left; bin <= right; ++bin) {
      const double rises = middle > left ? (bin - left) / (middle - left) : 1;
      const double falls = (right - bin) / (right - middle);
      filter.weights.push_back(
          static_cast<float>(std::min(rises, falls) * 2 / ((right - left) * kBinHz)));
    }
  }
  for (std::size_t c = 0; c < kCount; ++c) {
    const double lifter = 1 + kLifter / 2 * std::sin(static_cast<double>(c) * kPi / kLifter);
    const double norm = std::sqrt((c == 0 ? 1.0 : 2.0) / kFilters) * lifter;
    for (std::size_t f = 0; f < kFilters; ++f) {
      transform_[c][f] =
          static_cast<float>(norm * std::cos(static_cast<double>(c) * kPi / kFilters *
                                             (static_cast<double>(f) + 0.5)));
    }
  }
}

std::array<float, SpeechCepstra::kCount> SpeechCepstra::Of(
    float before, std::span<const std::int16_t> window) const {
  assert(window.size() == kWindow);
  std::array<float, kWindow> x;
  float mean = 0;  // a constant in the sound (DC) is none of it
  for (std::size_t i = 0; i < kWindow; ++i) {
    const auto sample = static_cast<float>(window[i]);
    x[i] = sample - kPreEmphasis * before;
    mean += x[i] / kWindow;
    before = sample;
  }
  for (std::size_t i = 0; i < kWindow; ++i) x[i] = (x[i] - mean) * window_[i];
  const auto power = fourier_.Power(x);
  std::array<float, kFilters> logs;
  for (std::size_t f = 0; f < kFilters; ++f) {
    float sum = 0;
    for (std::size_t i = 0; i < filters_[f].weights.size(); ++i) {
      sum += filters_[f].weights[i] * power[filters_[f].first + i];
    }
    logs[f] = std::log(sum + kLeast);
  }
  std::array<float, kCount> cepstra{};
  for (std::size_t c = 0; c < kCount; ++c) {
    for (std::size_t f = 0; f < kFilters; ++f) cepstra[c] += transform_[c][f] * logs[f];
  }
  return cepstra;
}

}  // namespace vdm
