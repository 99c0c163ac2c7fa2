#pragma once

#include <array>

#include "face_fit/fit/fit.h"
#include "fsm/head/photo_head.h"

namespace facefit {

/// The eyes at rest. Half of a smile's squint is kept: the photo does not show how wide the eyes
/// would be without it, and eyes that are too wide stare.
fsm::Sided<fsm::EyeTransform> EyesAtRest(const BaseHead& base, const Fit& fit);
/// Fills head.iris_colour, head.white_colour and head.iris_size from the photo.
void SampleEyes(const FoundFace& face, const Fit& fit, const fsm::Image& photo,
                fsm::PhotoHead& head);
/// Paints the irises and the white beside them into a corner of `picture` that shows nothing else,
/// and fills head.eye_pictures. What lids and irises hide is completed from around it. Does nothing
/// if no iris is seen clearly.
void PaintEyes(const BaseHead& base, const FoundFace& face, const Fit& fit, const fsm::Image& photo,
               fsm::Image& picture, fsm::PhotoHead& head);
inline constexpr float kLeastIris = 3;  ///< radius in pixels of what is worth showing
/// Fills head.lip_colour, for where the lips turn inward, and head.teeth, by the light on the skin.
void SampleMouth(const FoundFace& face, const fsm::Image& photo, fsm::PhotoHead& head);

}  // namespace facefit
