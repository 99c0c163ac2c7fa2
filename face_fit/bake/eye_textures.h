#pragma once

#include <optional>

#include "face_fit/fit/fit.h"
#include "fsm/rig/head_asset.h"

namespace facefit {

/// Paints the irises and the whites around them into the squares of `atlas` (head_atlas.h) and
/// returns where. What lids and irises hide is inpainted from around it. `at_rest`: the eyes of the
/// head. Returns nothing if no iris is seen clearly.
std::optional<fsm::Sided<fsm::EyePicture>> PaintEyes(const FoundFace& face, const FaceFit& fit,
                                                     const fsm::Sided<fsm::EyeTransform>& at_rest,
                                                     const fsm::Image& photo, fsm::Image& atlas);

}  // namespace facefit
