#pragma once

#include <glm/vec3.hpp>

#include "face_fit/dress/field.h"

namespace facefit {

/// Colour at a place of a picture (pixel centres at .5) that is shown larger: through the pixels by
/// cubics (Catmull and Rom), which a straight line between them would show as steps. 0..255.
glm::vec3 SharpColourAt(const fsm::Image& image, glm::vec2 at);

/// A field likewise, but evened out (cubic B-splines): its contours are smooth.
float SmoothAt(const FloatImage& field, glm::vec2 at);

}  // namespace facefit
