#include "vdm/features/mel_features.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vdm {
namespace {

constexpr double kLowHz = 80, kHighHz = 7200;
// A noise of about one step of 16 bits in each band: below it lies nothing but the arithmetic.
constexpr float kLeast = 300;

double MelOf(double hz) { return 1127 * std::log(1 + hz / 700); }
double HzOf(double mel) { return 700 * (std::exp(mel / 1127) - 1); }

}  // namespace

MelFeatures::MelFeatures(float warp) {
  for (std::size_t i = 0; i < kWindow; ++i) {
    const double angle = 2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / kWindow;
    window_[i] = static_cast<float>(0.5 - 0.5 * std::cos(angle));
  }
  const double low = MelOf(kLowHz);
  const double step = (MelOf(kHighHz) - low) / (LevelNormaliser::kBands + 1.0);
  constexpr double kBinHz = static_cast<double>(kSampleRateHz) / Fourier512::kSize;
  for (std::size_t b = 0; b < bands_.size(); ++b) {
    // A warped spectrum is read at other frequencies; the band keeps its place among the others.
    const auto edge = [&](std::size_t i) {
      const double hz = HzOf(low + step * static_cast<double>(b + i)) * static_cast<double>(warp);
      return std::min(hz, 7950.0) / kBinHz;
    };
    const double left = edge(0), middle = edge(1), right = edge(2);
    Band& band = bands_[b];
    band.first = static_cast<std::size_t>(std::ceil(left));
    float sum = 0;
    for (std::size_t k = band.first; static_cast<double>(k) < right; ++k) {
      const auto at = static_cast<double>(k);
      const double weight =
          at < middle ? (at - left) / (middle - left) : (right - at) / (right - middle);
      band.weights.push_back(static_cast<float>(weight));
      sum += band.weights.back();
    }
    if (band.weights.empty() || sum <= 0) {  // narrower than a bin, at low frequencies: the nearest
      band.first = static_cast<std::size_t>(std::lround(middle));
      band.weights.assign(1, 1.0F);
      sum = 1;
    }
    for (float& weight : band.weights) weight /= sum;
  }
}

void MelFeatures::Add(std::span<const std::int16_t> samples, std::vector<float>& vectors) {
  framer_.Add(samples, [&](std::span<const std::int16_t> sound) {
    // Less its mean: a constant in the sound (DC) is none of it.
    float mean = 0;
    for (const std::int16_t sample : sound) mean += static_cast<float>(sample);
    mean /= kWindow;
    std::array<float, kWindow> windowed;
    for (std::size_t i = 0; i < kWindow; ++i) {
      windowed[i] = (static_cast<float>(sound[i]) - mean) * window_[i];
    }
    const auto power = fourier_.Power(windowed);
    std::array<float, LevelNormaliser::kBands> levels;
    for (std::size_t b = 0; b < bands_.size(); ++b) {
      float sum = 0;
      for (std::size_t i = 0; i < bands_[b].weights.size(); ++i) {
        sum += bands_[b].weights[i] * power[bands_[b].first + i];
      }
      levels[b] = std::log(sum + kLeast);
    }
    const std::size_t at = vectors.size();
    vectors.resize(at + LevelNormaliser::kSize);
    normaliser_.Add(levels,
                    std::span<float, LevelNormaliser::kSize>(&vectors[at], LevelNormaliser::kSize));
  });
}

}  // namespace vdm
