#pragma once

#include "face_fit/dress/dress.h"

namespace facefit {

/// The figure's colours with the face taken out and what lies around it drawn over the gap: what is
/// seen beside the face when the head turns.
fsm::Image BehindFace(const BaseHead& base, const Fit& fit, const Figure& figure);

/// The sheet of hair, neck and clothes: just behind the face, from there gently back to the
/// outline. Also says from where the photo was taken and where the skin ends.
void MakeSheet(const BaseHead& base, const Fit& fit, const Figure& figure, fsm::PhotoHead& set);

}  // namespace facefit
