#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/picture/float_image.h"
#include "fsm/image/image.h"

namespace facefit {

// Colours between the pixels of a picture, whose centres lie at .5; outside the edge is repeated.
// Colours are 0..255. Pure; thread: any.

/// Bilinear interpolation.
glm::vec3 ColourAt(const fsm::Image& image, glm::vec2 at);

/// Bicubic interpolation through the pixels (Catmull and Rom), for a picture that is shown larger:
/// the bilinear kind would show as steps.
glm::vec3 SharpColourAt(const fsm::Image& image, glm::vec2 at);

/// By cubic B-splines, which smooth: contours have no steps.
float SmoothAt(const FloatImage& image, glm::vec2 at);

/// A parallelogram of a picture as networks take it: `pixels` x `pixels` RGB, each low..high, `low`
/// outside the picture. `corner`: of its first pixel; `axes`: its sides, in pixels of the picture.
/// Where many pixels fall into one, up to 8 x 8 places of it are averaged.
std::vector<float> Resampled(const fsm::Image& image, glm::vec2 corner, const glm::mat2& axes,
                             int pixels, float low, float high);

}  // namespace facefit
