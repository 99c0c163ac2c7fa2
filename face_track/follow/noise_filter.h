#pragma once

#include <optional>

#include "face_fit/find/network/network_crop.h"
#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facetrack {

/// Takes the noise off a face in a film, as far as it is measured: each pixel becomes the mean of
/// what was seen there in the pictures before, followed as it moves, as long as these differ by no
/// more than noise does. A film without noise stays as it is, to the bit. Not for several threads.
class NoiseFilter {
 public:
  /// The picture with less noise in `crop` and around it, or `picture` itself where there is next
  /// to none. Valid until the next call, as long as `picture`.
  const fsm::Image& Filter(const fsm::Image& picture, const facefit::NetworkCrop& crop);
  /// The next picture does not follow those before.
  void Forget();
  /// Whether there is more noise than the networks and the fit are used to.
  bool IsNoisy() const { return noise_.value_or(0) >= kMuchNoise * shrunk_; }

 private:
  static constexpr float kMuchNoise = 2;  // of 255, in what the networks are shown
  struct Area {
    int left, top, width, height;
  };
  void Measure(const fsm::Image& picture, const Area& area);
  void Average(const fsm::Image& picture, const Area& area);

  std::optional<float> noise_;    // its deviation, of 255
  float shrunk_ = 1;              // by how much the networks are shown a face smaller than it is
  fsm::Image before_;             // the picture before
  fsm::Image mean_;               // what was made of it; none where it was left as it was
  facefit::FloatImage pictures_;  // of how many each pixel of `mean_` is the mean
};

}  // namespace facetrack
