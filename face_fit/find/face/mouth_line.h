#pragma once

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// Whether teeth or the dark of the mouth show between the lips.
bool LipsApart(const FoundFace& face);

inline constexpr std::size_t kMouthLinePoints = 41;

/// Where closed lips meet: the dark line between them, followed in the photo from the person's
/// right corner of the mouth to the left one, `kMouthLinePoints` places at even steps along the
/// mouth. The network's own points lie a few pixels off it, which is seen as soon as the lips part.
/// `first`, `last`: how far along the mouth from the right corner, 0..1, its corners as the network
/// sees them lie.
std::vector<glm::vec2> FindMouthLine(const fsm::Image& photo, const FoundFace& face, float first,
                                     float last);

}  // namespace facefit
