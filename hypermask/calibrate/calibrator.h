#pragma once

#include <optional>
#include <vector>

#include "hypermask/base/grey.h"
#include "hypermask/calibrate/dot_pattern.h"
#include "hypermask/find/marker_finder.h"
#include "hypermask/project/calibration.h"

namespace hypermask {

/// The mask held still somewhere: its markers in the camera's picture, and dots on it in both
/// pictures.
struct Place {
  Points markers{};
  Points seen{};       ///< dots in the camera's picture
  Points projected{};  ///< the same in the projector's
};

/// What the camera saw of each frame of the pattern makes a place. Errors, kUnavailable: no mask,
/// the mask moved, too few dots on it.
vm::Result<Place> ReadPlace(const DotPattern& pattern, const std::vector<Grey>& pictures,
                            const MarkerFinder& finder);

/// Shows the frames of the pattern one after the other and gathers what the camera sees of them:
/// the mean of kPictures pictures each. Pure: told the times, ms. Thread: one.
class PlaceTaker {
 public:
  static constexpr int kPictures = 3;
  /// `settle_ms`: after so long a picture shows what was to be projected.
  PlaceTaker(const DotPattern& pattern, double settle_ms)
      : pattern_(pattern), settle_ms_(settle_ms) {}
  /// What is to be projected from `ms` on; nothing once all was seen.
  std::optional<fsm::Image> Begin(double ms);
  /// A picture that was there at `ms`. True if the next frame is to be shown.
  bool Take(const Grey& picture, double ms);
  const std::vector<Grey>& pictures() const { return pictures_; }

 private:
  const DotPattern& pattern_;
  const double settle_ms_;
  double shown_ms_ = 0;
  int taken_ = 0;
  std::vector<int> sum_;
  std::vector<Grey> pictures_;
};

/// How many places are needed: the third form needs the mask nearer and farther.
inline constexpr std::size_t kLeastPlaces = 3, kMostPlaces = 32;

/// What camera and projector are to each other. `camera`: its focal length is taken as given; what
/// it is wrong by is nearly all made up for by the projector that is then found. Errors,
/// kUnavailable: too few places, or all in one plane.
vm::Result<Calibration> Calibrate(const std::vector<Place>& places, const MaskLayout& layout,
                                  const Pinhole& camera, int projector_width, int projector_height);

}  // namespace hypermask
