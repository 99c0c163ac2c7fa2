#pragma once

#include "face_fit/find/network/face_finder.h"
#include "face_fit/picture/float_image.h"

namespace facefit {

/// How much each pixel belongs to a person, 0..1, as fine as the network's 256 x 256. If `face` is
/// given, the surroundings of the head are looked at a second time from nearer, and DoubtAsymmetry
/// corrects the result.
FloatImage SegmentPerson(FaceNetworks& networks, const fsm::Image& image,
                         const FoundFace* face = nullptr);

/// Heads are nearly symmetric: where one side of a face that looks into the camera belongs to the
/// person and its mirror image does not, as with an ear or half a hat, the network may have missed
/// the latter. Returns `person`, where pixels belong to a person, with such pixels set to doubt, or
/// to nearly as much as on the other side where both have one colour. Only near the head: what
/// stands behind it is of one colour with it often enough.
FloatImage DoubtAsymmetry(const FoundFace& face, const fsm::Image& image, const FloatImage& person);

}  // namespace facefit
