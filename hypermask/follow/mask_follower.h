#pragma once

#include <optional>

#include "hypermask/find/marker_finder.h"
#include "hypermask/follow/predictor.h"

namespace hypermask {

/// Follows the mask from picture to picture:
///
///   looking --all corners seen--> following --unseen for kPatience--> looking
///
/// Pure: knows no clock; times are of the pictures, seconds. Thread: one.
class MaskFollower {
 public:
  /// So long a mask that is no longer seen is still foretold, seconds.
  static constexpr double kPatience = 0.25;

  struct Settings {
    Prediction prediction = Prediction::kBank;
    double ahead = 0.1;  ///< seconds that will be made up for; Predictor
    SpotSearch spots{};
  };
  MaskFollower(MaskLayout layout, const Settings& settings);

  /// Looks at the next picture, taken at `seconds`. The number of markers seen; 0 = no mask.
  std::size_t Look(const Grey& picture, double seconds);
  /// Where the markers will be in the camera's picture at `seconds`; nothing while looking.
  std::optional<Points> At(double seconds) const;
  /// The markers of the last picture that showed the mask; empty while looking.
  const Points& markers() const { return markers_; }
  bool following() const { return !markers_.empty(); }
  const Predictor& predictor() const { return predictor_; }
  const MaskLayout& layout() const { return finder_.layout(); }
  /// Bright spots in the last picture, whatever they are.
  std::size_t spots() const { return spots_; }

 private:
  const Settings settings_;
  const MarkerFinder finder_;
  Predictor predictor_;  // foretells the face's place
  Predictor tracker_;    // where to look next: constant velocity
  Points markers_;
  double seen_at_ = 0;
  std::size_t spots_ = 0;
};

}  // namespace hypermask
