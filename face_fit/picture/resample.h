#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/picture/float_image.h"
#include "fsm/image/image.h"

namespace facefit {

// Colours between the pixels of a picture, whose centres lie at .5; the edge goes on outside.
// Colours are 0..255. Pure; thread: any.

/// By straight lines between the pixels.
glm::vec3 ColourAt(const fsm::Image& image, glm::vec2 at);

/// For a picture that is shown larger: through the pixels by cubics (Catmull and Rom), because
/// straight lines would show as steps.
glm::vec3 SharpColourAt(const fsm::Image& image, glm::vec2 at);

/// Likewise, but evened out (cubic B-splines): its contours are smooth.
float SmoothAt(const FloatImage& image, glm::vec2 at);

/// A parallelogram of a picture as networks take it: `pixels` x `pixels` RGB, each low..high, `low`
/// outside the picture. `corner`: of its first pixel; `axes`: its sides, in pixels of the picture.
/// Where many pixels fall into one, up to 8 x 8 places of it are averaged.
std::vector<float> Resampled(const fsm::Image& image, glm::vec2 corner, const glm::mat2& axes,
                             int pixels, float low, float high);

/// How bright a colour is, in its own unit: of a face's reds more is counted than eyes would.
inline float Brightness(glm::vec3 c) { return 0.3F * c.r + 0.5F * c.g + 0.2F * c.b; }

}  // namespace facefit
