#pragma once

#include "face_fit/complete/complete_figure.h"
#include "face_fit/fit/side_view.h"
#include "fsm/head/photo_head.h"

namespace facefit {

/// A head made from a photo. Left half of its `photo`: the skin, laid out by the head's texture
/// coordinates, alpha = how much is skin. Right half: the figure with hair, neck and clothes, and
/// its opacity.
struct TextureBake {
  fsm::PhotoHead head;
  float coverage = 0;   ///< how much of the face's map the photo shows, 0..1
  Completed completed;  ///< what of the figure it does not
};

/// `figure`: of `photo`; `side_views`: photos of the same person from the side, may be empty. Pure;
/// thread: any.
TextureBake BakeTexture(const FoundFace& face, const Fit& fit, const fsm::Image& photo,
                        const FigureCutout& figure, std::span<const SideView> side_views);

}  // namespace facefit
