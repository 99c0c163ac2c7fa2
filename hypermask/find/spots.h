#pragma once

#include <vector>

#include "hypermask/base/grey.h"
#include "hypermask/geometry/plane_map.h"

namespace hypermask {

/// A bright spot of a picture.
struct Spot {
  Point place{0, 0};  ///< its middle, weighted by how much each pixel is above the threshold
  double weight = 0;  ///< sum of that, in steps of brightness
  int pixels = 0;     ///< how many are above the threshold
};

struct SpotSearch {
  /// Of the way from the picture's median brightness to its brightest pixel, where spots begin.
  double threshold = 0.6;
  /// A picture whose brightest pixel is not so much above its median has no spots.
  int least_contrast = 40;
  int least_pixels = 2;
  int most_pixels = 2500;  ///< larger ones are lamps or windows
  std::size_t most = 12;   ///< the heaviest are kept
};

/// Connected bright pixels (OpenCV's connectedComponentsWithStats, 8 neighbours), the heaviest
/// first. A spot that touches the picture's edge is left out, since its middle is not known.
std::vector<Spot> FindSpots(const Grey& picture, const SpotSearch& search);

}  // namespace hypermask
