#include "face_space/emotion/whereabouts.h"

#include <algorithm>
#include <cmath>

#include "face_space/emotion/space_training.h"

namespace facespace {
namespace {

double Dot(const fsm::EmotionSpace::Point& a, const fsm::EmotionSpace::Point& b) {
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) sum += static_cast<double>(a[k]) * static_cast<double>(b[k]);
  return sum;
}

}  // namespace

Whereabouts WhereIs(const fsm::EmotionSpace& space, const fsm::FaceLook& look) {
  const std::vector<float> ratios = RatiosOf(space, look);
  Whereabouts out{.at = space.PointOf(ratios), .emotion = "NEUTRAL"};
  const double away = std::sqrt(Dot(out.at, out.at));
  double nearest = -2;
  for (const auto& [emotion, at] : space.emotions) {
    const double far = std::sqrt(Dot(at, at));
    const double cosine = Dot(out.at, at) / std::max(away * far, 1e-9);
    if (away < kNeutralWithin || cosine <= nearest) continue;
    nearest = cosine;
    out.emotion = emotion;
    out.strength = away / std::max(far, 1e-9);
  }
  const std::vector<float> again = space.RatiosAt(out.at);
  double all = 0, missed = 0;
  for (std::size_t unit = 0; unit < std::max(look.au.left.size(), look.au.right.size()); ++unit) {
    const double strength =
        (static_cast<double>(look.au.left[unit]) + static_cast<double>(look.au.right[unit])) / 2;
    const auto found = std::ranges::find(space.units, static_cast<int>(unit));
    const double given =
        found == space.units.end()
            ? 0
            : static_cast<double>(again[static_cast<std::size_t>(found - space.units.begin())]);
    all += strength * strength;
    missed += (strength - given) * (strength - given);
  }
  out.held = all > 1e-6 ? std::clamp(1 - missed / all, 0.0, 1.0) : 1;
  return out;
}

}  // namespace facespace
