#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/find/network/face_finder.h"
#include "face_fit/image/raster.h"

namespace facefit {

/// Returns how much each pixel belongs to a person, 0..1, with the detail of the network's 256 x
/// 256. If `face` is given, the result is refined for that person:
/// - the surroundings of the head are segmented a second time from nearer;
/// - what is not connected to the tip of the nose becomes 0;
/// - SymmetriseHead corrects the sides of the head;
/// - where the network sees nobody on the face, the outline of the face and the neck below it
///   become 1 and everything else 0; beside a cheek whose ear the photo cuts off likewise.
Mask SegmentPerson(FaceNetworks& networks, const fsm::Image& image,
                   const FoundFace* face = nullptr);

/// Cuts out the figure that SegmentPerson finds.
FigureCutout FindFigure(FaceNetworks& networks, const fsm::Image& photo,
                        const FoundFace* face = nullptr);

/// Returns `person`, 0..1, with the sides of the head made more alike: where one side of a face
/// that looks into the camera belongs to the person and its mirror image does not (an ear, half a
/// hat), the network may have missed the latter. Such pixels become uncertain, or nearly as certain
/// as the other side where both have one colour. Only near the head, since things behind it often
/// have its colour.
Mask SymmetriseHead(const FoundFace& face, const fsm::Image& image, const Mask& person);

}  // namespace facefit
