#include "film_dub/timing/dub_timing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace filmdub {

double PicturesPerSecond(std::span<const double> times_ms) {
  assert(times_ms.size() >= 2);
  std::vector<double> steps;
  for (std::size_t i = 1; i < times_ms.size(); ++i) {
    steps.push_back(times_ms[i] - times_ms[i - 1]);
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  // Times are told in whole units of the film's clock: of many pictures the mean is finer.
  double sum = 0;
  std::size_t count = 0;
  for (const double step : steps) {
    if (std::abs(step - *middle) > 0.2 * *middle) continue;
    sum += step;
    ++count;
  }
  return std::clamp(1000.0 * static_cast<double>(count) / std::max(sum, 1e-3), 1.0, 1000.0);
}

vm::Result<std::vector<std::size_t>> FitLength(std::span<const double> times_ms, double rate,
                                               double sound_s) {
  assert(!times_ms.empty());
  const double film_s = (times_ms.back() - times_ms.front()) / 1000 + 1 / rate;
  const double slower = sound_s / film_s;
  if (slower > kMostStretch || slower < 1 / kMostStretch) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("the film lasts {:.2f} s and its new sound {:.2f}: expected at most "
                    "{:g} times as long or as short",
                    film_s, sound_s, kMostStretch));
  }
  std::vector<std::size_t> shown(static_cast<std::size_t>(std::ceil(sound_s * rate - 1e-6)));
  for (std::size_t i = 0; i < shown.size(); ++i) {
    // The middle of a picture's time, so that a film as long as its sound is shown as it is.
    const double at_ms = (static_cast<double>(i) + 0.5) / rate * 1000 / slower + times_ms.front();
    const auto after = std::ranges::upper_bound(times_ms, at_ms + 1e-6);
    shown[i] = static_cast<std::size_t>(after - times_ms.begin()) - 1;
  }
  return shown;
}

}  // namespace filmdub
