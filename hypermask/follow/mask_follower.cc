#include "hypermask/follow/mask_follower.h"

#include <algorithm>

namespace hypermask {
namespace {

/// How far from where it was expected a marker is still taken for it: in parts of the distance of
/// the upper corners, which are the nearest to each other; and at least, pixels.
constexpr double kReach = 0.25, kLeastReach = 6;

}  // namespace

MaskFollower::MaskFollower(MaskLayout layout, const Settings& settings)
    : settings_(settings),
      finder_(std::move(layout)),
      predictor_(settings.prediction, settings.ahead),
      tracker_(Prediction::kSingle, 0) {}

std::size_t MaskFollower::Look(const Grey& picture, double seconds) {
  const auto spots = FindSpots(picture, settings_.spots);
  spots_ = spots.size();
  std::optional<FoundMarkers> found;
  if (following()) {
    const double reach = std::max(kLeastReach, kReach * (markers_[1] - markers_[0]).norm());
    found = finder_.Follow(spots, tracker_.At(seconds), reach);
  }
  if (!found || found->seen < 4) {
    // A jump, or a first picture; three markers hold the mask only where it was expected.
    if (auto fresh = finder_.Search(spots)) found = std::move(fresh);
  }
  if (found) {
    markers_ = found->places;
    seen_at_ = seconds;
    tracker_.Measure(seconds, markers_);
    predictor_.Measure(seconds, markers_);
    return found->seen;
  }
  if (following() && seconds - seen_at_ > kPatience) {
    markers_.clear();
    predictor_.Forget();
    tracker_.Forget();
  }
  return 0;
}

std::optional<Points> MaskFollower::At(double seconds) const {
  if (!following()) return std::nullopt;
  return predictor_.At(seconds);
}

}  // namespace hypermask
