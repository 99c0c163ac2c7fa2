#pragma once

#include <string>

#include "face_fit/bake/bake_head.h"
#include "face_fit/front_photo.h"

namespace facefit {

/// Returns the measurements, a line each, and warnings of what could look better. `completed`,
/// `baked`: what CompleteFigure and BakeHead made of the photo and the fit.
std::string Report(const FrontPhoto& front, const FrontFace& face, const FaceFit& fit,
                   const Completed& completed, const BakedHead& baked);

}  // namespace facefit
