#pragma once

#include "face_fit/complete/complete_figure.h"
#include "face_fit/side/use_side_photos.h"
#include "fsm/head/photo_head.h"

namespace facefit {

/// A head made from a photo; head_atlas.h says how its atlas is laid out.
struct BakedHead {
  fsm::PhotoHead head;
  float coverage = 0;  ///< share of the face's map that photos show, 0..1
};

/// Bakes a photo onto a fitted head. `figure`: the figure in `photo`; `whole`: CompleteFigure of
/// it; `side_photos`: photos of the person from the side, may be empty; `glasses`: whether the
/// person wears them. Pure; thread: any.
BakedHead BakeHead(const FoundFace& face, const FaceFit& fit, const fsm::Image& photo,
                   const FigureCutout& figure, const CompletedFigure& whole,
                   std::span<const PosedSidePhoto> side_photos, bool glasses);

}  // namespace facefit
