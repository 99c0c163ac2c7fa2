#include "ssm/voice/resample.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace ssm {
namespace {

constexpr double kCrossings = 32;

/// The filter at `x` zero crossings from its middle.
double Kernel(double x) {
  if (std::abs(x) >= kCrossings) return 0;
  const double angle = std::numbers::pi * x;
  const double sinc = x == 0 ? 1 : std::sin(angle) / angle;
  const double turn = angle / kCrossings;
  return sinc * (0.42 + 0.5 * std::cos(turn) + 0.08 * std::cos(2 * turn));
}

}  // namespace

std::vector<std::int16_t> Resample(std::span<const std::int16_t> samples, std::int64_t from_hz,
                                   std::int64_t to_hz) {
  assert(from_hz >= 1000 && to_hz >= 1000 && from_hz <= 400'000 && to_hz <= 400'000);
  if (from_hz == to_hz) return {samples.begin(), samples.end()};
  const std::int64_t divisor = std::gcd(from_hz, to_hz);
  const std::int64_t up = to_hz / divisor, down = from_hz / divisor;
  // In units of input frames: below the lower of the two half rates everything passes.
  const double cutoff = std::min(1.0, static_cast<double>(to_hz) / static_cast<double>(from_hz));
  const auto reach = static_cast<std::int64_t>(std::ceil(kCrossings / cutoff));

  // Output frame n lies at input n * down / up; only `up` different fractions occur.
  const auto taps = static_cast<std::size_t>(2 * reach + 1);
  std::vector<float> table(static_cast<std::size_t>(up) * taps);
  for (std::int64_t phase = 0; phase < up; ++phase) {
    const double fraction = static_cast<double>(phase) / static_cast<double>(up);
    float* row = table.data() + static_cast<std::size_t>(phase) * taps;
    for (std::int64_t k = -reach; k <= reach; ++k) {
      const double weight = cutoff * Kernel((static_cast<double>(k) - fraction) * cutoff);
      row[static_cast<std::size_t>(k + reach)] = static_cast<float>(weight);
    }
  }

  const auto size = static_cast<std::int64_t>(samples.size());
  std::vector<std::int16_t> result(static_cast<std::size_t>(size * up / down));
  for (std::size_t n = 0; n < result.size(); ++n) {
    const std::int64_t at = static_cast<std::int64_t>(n) * down;
    const std::int64_t whole = at / up;
    const float* row = table.data() + static_cast<std::size_t>(at % up) * taps;
    const std::int64_t first = std::max<std::int64_t>(-reach, -whole);
    const std::int64_t last = std::min(reach, size - 1 - whole);
    float sum = 0;
    for (std::int64_t k = first; k <= last; ++k) {
      sum += row[static_cast<std::size_t>(k + reach)] *
             static_cast<float>(samples[static_cast<std::size_t>(whole + k)]);
    }
    result[n] = static_cast<std::int16_t>(std::lround(std::clamp(sum, -32768.f, 32767.f)));
  }
  return result;
}

}  // namespace ssm
