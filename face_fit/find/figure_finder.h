#pragma once

#include <vector>

#include "face_fit/find/face_finder.h"

namespace facefit {

/// How much each pixel belongs to a person, 0..1, as large as the picture; blurred to the network's
/// 256 x 256. Round `face` it looks a second time, from nearer, and doubts what is one-sided.
std::vector<float> FindFigure(FaceNetworks& networks, const fsm::Image& image,
                              const FoundFace* face = nullptr);

/// A head is alike on both sides: where one shows what the other does not, as an ear or half a hat,
/// the network may have missed it. Nothing is said there, or rather yes if the colours are alike.
void DoubtOneSided(const FoundFace& face, const fsm::Image& image, std::vector<float>& person);

}  // namespace facefit
