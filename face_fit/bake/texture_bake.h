#pragma once

#include "face_fit/complete/complete_figure.h"
#include "face_fit/fit/side_view.h"
#include "fsm/head/photo_head.h"

namespace facefit {

/// A head made from a photo. The left half of its `photo` is the skin, laid out by the head's
/// texture coordinates, alpha = how much is skin; the right half is the figure with hair, neck and
/// clothes, alpha = its opacity.
struct TextureBake {
  fsm::PhotoHead head;
  float coverage = 0;   ///< part of the face's map that photos show, 0..1
  Completed completed;  ///< parts of the figure that the photo does not show
};

/// Bakes a photo onto a fitted head. `figure`: the figure in `photo`; `side_views`: photos of the
/// person from the side, may be empty. Pure; thread: any.
TextureBake BakeTexture(const FoundFace& face, const Fit& fit, const fsm::Image& photo,
                        const FigureCutout& figure, std::span<const SideView> side_views);

}  // namespace facefit
