#include "vdm/features/cepstra_features.h"

#include <cmath>
#include <numbers>

namespace vdm {
namespace {

// White noise added to the autocorrelation, as is usual, so that silence and pure tones have a
// stable prediction too.
constexpr double kNoise = 1e-4;
constexpr double kLeast = 2000;  // power of a window of silence at 16 bits

}  // namespace

CepstraFeatures::CepstraFeatures() {
  for (std::size_t i = 0; i < kWindow; ++i) {
    window_[i] =
        0.54 - 0.46 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / (kWindow - 1));
  }
}

void CepstraFeatures::Add(std::span<const std::int16_t> samples, std::vector<float>& vectors) {
  framer_.Add(samples, [&](std::span<const std::int16_t> sound) {
    std::array<double, kWindow> x;
    double mean = 0;
    for (const std::int16_t sample : sound) mean += sample;
    mean /= kWindow;
    for (std::size_t i = 0; i < kWindow; ++i) x[i] = window_[i] * (sound[i] - mean);
    std::array<double, kOrder + 1> r{};
    for (std::size_t lag = 0; lag <= kOrder; ++lag) {
      for (std::size_t i = lag; i < kWindow; ++i) r[lag] += x[i] * x[i - lag];
    }
    const double power = r[0] + kLeast;
    r[0] = power * (1 + kNoise);
    std::array<double, kOrder + 1> a{};  // prediction: x_i = sum a_k x_{i-k}
    double error = r[0];
    for (std::size_t i = 1; i <= kOrder; ++i) {
      double reflection = r[i];
      for (std::size_t k = 1; k < i; ++k) reflection -= a[k] * r[i - k];
      reflection /= error;
      const std::array<double, kOrder + 1> before = a;
      a[i] = reflection;
      for (std::size_t k = 1; k < i; ++k) a[k] = before[k] - reflection * before[i - k];
      error *= 1 - reflection * reflection;
    }
    std::array<double, kOrder + 1> c{};
    for (std::size_t n = 1; n <= kOrder; ++n) {
      c[n] = a[n];
      for (std::size_t k = 1; k < n; ++k) {
        c[n] += static_cast<double>(k) / static_cast<double>(n) * c[k] * a[n - k];
      }
    }
    vectors.push_back(static_cast<float>((std::log(power) - 18) / 4));
    for (std::size_t n = 1; n < kOrder; ++n) {
      vectors.push_back(static_cast<float>(c[n] * std::sqrt(static_cast<double>(n)) * 1.5));
    }
  });
}

}  // namespace vdm
