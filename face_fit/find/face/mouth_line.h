#pragma once

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// Returns whether the lips are parted, so that teeth or the dark of the mouth show between them.
bool LipsApart(const FoundFace& face);

inline constexpr std::size_t kMouthLinePoints = 41;

/// Follows the dark line along which closed lips meet, from the person's right corner of the mouth
/// to the left one; the network's own points are a few pixels off, which shows as soon as the lips
/// part. Returns kMouthLinePoints pixels at equal steps along the mouth. `first`, `last`: positions
/// along the mouth, 0 = its right end and 1 = its left end, of the network's two corners.
std::vector<glm::vec2> FindMouthLine(const fsm::Image& photo, const FoundFace& face, float first,
                                     float last);

}  // namespace facefit
