#include "fsm/motion/inputs/motion_patterns.h"

#include <algorithm>
#include <cassert>

namespace fsm {

HeadCurve::HeadCurve(std::vector<Key> keys) : keys_(std::move(keys)) {
  keys_.insert(keys_.begin(), Key{});
  assert(keys_.size() >= 2);
  slopes_.resize(keys_.size());
  for (std::size_t i = 1; i + 1 < keys_.size(); ++i) {
    const double before = keys_[i].ms - keys_[i - 1].ms;
    const double after = keys_[i + 1].ms - keys_[i].ms;
    assert(before > 0 && after > 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double a = (keys_[i].angles[axis] - keys_[i - 1].angles[axis]) / before;
      const double b = (keys_[i + 1].angles[axis] - keys_[i].angles[axis]) / after;
      if (a * b <= 0) continue;  // a turning point
      const double wa = 2 * after + before;
      const double wb = after + 2 * before;
      slopes_[i][axis] = static_cast<float>((wa + wb) / (wa / a + wb / b));
    }
  }
}

Angles HeadCurve::At(double ms) const {
  if (ms <= 0) return keys_.front().angles;
  if (ms >= keys_.back().ms) return keys_.back().angles;
  const auto next = std::ranges::upper_bound(keys_, ms, {}, &Key::ms);
  const auto i = static_cast<std::size_t>(next - keys_.begin()) - 1;
  const double span = keys_[i + 1].ms - keys_[i].ms;
  const double u = (ms - keys_[i].ms) / span;
  Angles out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double p0 = keys_[i].angles[axis];
    const double p1 = keys_[i + 1].angles[axis];
    const double m0 = slopes_[i][axis] * span;
    const double m1 = slopes_[i + 1][axis] * span;
    // The cubic Hermite polynomial.
    out[axis] = static_cast<float>(
        p0 + u * (m0 + u * (3 * (p1 - p0) - 2 * m0 - m1 + u * (2 * (p0 - p1) + m0 + m1))));
  }
  return out;
}

vm::Time LengthOf(const BlinkPattern& pattern) {
  return FromMs(pattern.closing_ms + pattern.shut_ms + pattern.opening_ms);
}

double LidsAt(const BlinkPattern& pattern, vm::Time since) {
  const double ms = InMs(since);
  if (ms <= 0) return 0;
  if (ms < pattern.closing_ms) return SmoothStep(ms / pattern.closing_ms);
  const double opening = ms - pattern.closing_ms - pattern.shut_ms;
  if (opening <= 0) return 1;
  if (opening >= pattern.opening_ms) return 0;
  return 1 - SmoothStep(opening / pattern.opening_ms);
}

}  // namespace fsm
