#pragma once

#include <glm/mat2x2.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

// Colours, 0..255, between the pixels of an image, whose centres lie at .5; outside, the edge is
// repeated. Pure; thread: any.

/// Bilinear interpolation.
glm::vec3 ColourAt(const fsm::Image& image, glm::vec2 at);

/// Bicubic interpolation through the pixels (Catmull and Rom), for magnified images, in which
/// bilinear interpolation would show steps.
glm::vec3 SharpColourAt(const fsm::Image& image, glm::vec2 at);

/// Smoothing interpolation by cubic B-splines, which leaves no steps in contours.
float SmoothAt(const FloatImage& image, glm::vec2 at);

/// Returns a parallelogram of an image as input of a network: `pixels` x `pixels` RGB, each
/// low..high, `low` outside the image. `corner`: of its first pixel; `axes`: its sides, in pixels
/// of the image. If minified, up to 8 x 8 samples are averaged for each pixel.
std::vector<float> Resampled(const fsm::Image& image, glm::vec2 corner, const glm::mat2& axes,
                             int pixels, float low, float high);

}  // namespace facefit
