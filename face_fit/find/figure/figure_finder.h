#pragma once

#include <vector>

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// How much each pixel belongs to a person: width * height numbers of 0..1, as fine as the
/// network's 256 x 256. If `face` is given, the surroundings of the head are looked at a second
/// time from nearer, and DoubtOneSided corrects the result.
std::vector<float> FindFigure(FaceNetworks& networks, const fsm::Image& image,
                              const FoundFace* face = nullptr);

/// Heads are nearly symmetric: where one side of the face belongs to the person and its mirror
/// image does not, as with an ear or half a hat, the network may have missed the latter. Such
/// pixels of `person` are set to doubt, 0.5, or to 0.85 of the other side where both have one
/// colour.
void DoubtOneSided(const FoundFace& face, const fsm::Image& image, std::vector<float>& person);

}  // namespace facefit
