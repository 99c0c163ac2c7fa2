#pragma once

#include "face_fit/find/figure/matte.h"
#include "face_fit/find/network/found_face.h"
#include "face_fit/image/raster.h"

namespace facefit {

class FaceNetworks;

/// Cuts out the figures of a photo, as the segmentation network sees them.
FigureCutout FindFigure(FaceNetworks& networks, const fsm::Image& photo);
/// Cuts out the figure of the person with this face:
/// - the surroundings of the head are segmented a second time from nearer;
/// - what is not connected to the tip of the nose is left out;
/// - SymmetriseHead corrects the sides of the head;
/// - where the network sees nobody on the face, the figure is the outline of the face and the neck
///   below it; beside a cheek whose ear the photo cuts off likewise.
FigureCutout FindFigureOf(FaceNetworks& networks, const fsm::Image& photo, const FoundFace& face);

/// Returns `person`, 0..1, with the sides of the head made more alike: where one side of a face
/// that looks into the camera belongs to the person and its mirror image does not (an ear, half a
/// hat), the network may have missed the latter. Such pixels become uncertain, or nearly as certain
/// as the other side where both have one colour. Only near the head, since things behind it often
/// have its colour.
Mask SymmetriseHead(const FoundFace& face, const fsm::Image& image, const Mask& person);

}  // namespace facefit
