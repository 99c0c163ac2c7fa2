#pragma once

#include "face_fit/find/network/face_finder.h"
#include "fsm/base/side.h"

namespace facefit {

inline constexpr std::size_t kSeamPoints = 41;

/// Follows the seam, a dark line, from the person's right corner of the mouth
/// to the left one; the network's own points are a few pixels off, which shows as soon as the lips
/// part. Returns kSeamPoints pixels at equal steps along the mouth. `corners_along`: where
/// along the mouth the network's corners lie, 0 = its right end and 1 = its left end.
std::vector<glm::vec2> FindPhotoSeam(const fsm::Image& photo, const FoundFace& face,
                                     fsm::Sided<float> corners_along);

}  // namespace facefit
