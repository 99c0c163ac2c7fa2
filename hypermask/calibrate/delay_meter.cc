#include "hypermask/calibrate/delay_meter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hypermask {

double DelayMeter::NextHoldMs() {
  random_ = 1664525u * random_ + 1013904223u;  // Numerical Recipes, ranqd1
  return kLeastHoldMs +
         (kMostHoldMs - kLeastHoldMs) * static_cast<double>(random_ >> 8) / (1 << 24);
}

void DelayMeter::Shown(double ms, bool on) {
  if (switches_.size() < kMostSeen) switches_.push_back({ms, on});
}

void DelayMeter::Seen(double ms, double brightness) {
  if (sights_.size() < kMostSeen) sights_.push_back({ms, brightness});
}

bool DelayMeter::OnAt(double ms) const {
  const auto after = std::ranges::upper_bound(switches_, ms, {}, &Switch::ms);
  return after != switches_.begin() && std::prev(after)->on;
}

vm::Result<double> DelayMeter::Delay() const {
  constexpr std::size_t kLeastSeen = 40;
  constexpr double kLeastContrast = 3, kLeastLikeness = 0.6;
  // Only pictures before which the field was known for the longest delay.
  std::vector<Sight> used;
  for (const Sight& sight : sights_) {
    if (!switches_.empty() && sight.ms - kLongestMs >= switches_.front().ms) used.push_back(sight);
  }
  if (used.size() < kLeastSeen) {
    return vm::Fail(vm::Errc::kUnavailable,
                    fmt::format("the camera gave {} pictures while the delay was measured, "
                                "expected at least {}",
                                used.size(), kLeastSeen));
  }
  const double count = static_cast<double>(used.size());
  double mean = 0, variance = 0;
  for (const Sight& sight : used) mean += sight.brightness / count;
  for (const Sight& sight : used) variance += std::pow(sight.brightness - mean, 2) / count;
  // The correlation at each delay. Several agree, as pictures come only now and then: their middle.
  std::vector<double> likeness;
  for (double delay = 0; delay <= kLongestMs; delay += 1) {
    double lit = 0, product = 0;
    for (const Sight& sight : used) {
      if (!OnAt(sight.ms - delay)) continue;
      lit += 1 / count;
      product += (sight.brightness - mean) / count;
    }
    const double spread = std::sqrt(variance * lit * (1 - lit));
    likeness.push_back(spread > 0 ? product / spread : 0);
  }
  const auto best = std::ranges::max_element(likeness);
  if (std::sqrt(variance) < kLeastContrast || *best < kLeastLikeness) {
    return vm::Fail(vm::Errc::kUnavailable,
                    "the camera does not see the projector's flashes (take the infrared filter off "
                    "while the delay is measured)");
  }
  const double enough = *best - 0.01;
  auto first = best, last = best;
  while (first != likeness.begin() && *std::prev(first) >= enough) --first;
  while (std::next(last) != likeness.end() && *std::next(last) >= enough) ++last;
  return 0.5 * static_cast<double>((first - likeness.begin()) + (last - likeness.begin()));
}

}  // namespace hypermask
