#pragma once

#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "face_fit/picture/float_image.h"
#include "fsm/image/image.h"

namespace facefit {

// Filters of pictures. OpenCV (core and imgproc) does the work; only filters.cc includes it.
// All are pure and run on the caller's thread. REQUIRES: pictures of at least one pixel.

/// The mean over squares of `2 * reach + 1` pixels, at the edges over what lies in the picture.
/// For FloatImage, VectorImage and Raster<glm::mat3>.
template <typename T>
Raster<T> Blurred(const Raster<T>& image, int reach);

/// A morphological closing of each channel by squares of `2 * reach + 1` pixels (Serra 1982): dark
/// places that no such square fits into are filled. For FloatImage and VectorImage.
template <typename T>
Raster<T> Closed(const Raster<T>& image, int reach);

/// Fills what has no weight with the colours around it, which are the wider averages the farther
/// away they are (push and pull through a pyramid of halved pictures; Gortler, Grzeszczuk, Szeliski
/// and Cohen, The Lumigraph, 1996). Full weight stays as it is. `weight`: 0..1, as large as
/// `image`.
void PushPullInpaint(fsm::Image& image, const FloatImage& weight);

/// Sets to 1 what is greater than 0 and every hole in it, that is every 0 that is not connected to
/// the picture's edge by its four neighbours; the rest becomes 0.
void FillHoles(FloatImage& image);

/// Sets to 0 what is not connected to a pixel by its eight neighbours through pixels of at least
/// 0.1. Does nothing if that pixel is less. A pixel outside counts as the nearest one within.
void KeepConnected(glm::ivec2 to, FloatImage& image);

/// For each pixel the index of the nearest one that is at least `threshold`, its own included.
/// Distances are right to about 2 %, so of two at nearly the same distance either is returned.
/// REQUIRES: there is such a pixel.
std::vector<std::size_t> NearestAbove(const FloatImage& image, float threshold);

/// How far outside a closed line a place lies, negative within.
float SignedDistance(std::span<const glm::vec2> outline, glm::vec2 place);

/// Each pixel is the mean of those it covers. REQUIRES: 1 <= width <= image.width, likewise height.
fsm::Image ScaledDown(const fsm::Image& image, int width, int height);
/// For FloatImage and VectorImage.
template <typename T>
Raster<T> ScaledDown(const Raster<T>& image, int width, int height);

/// The picture as it is, or scaled down if it is wider or higher than `most_size` pixels.
fsm::Image ScaledToFit(fsm::Image image, int most_size);

/// A copy of `width` x `height` pixels from (left, top). REQUIRES: they lie within the picture.
fsm::Image Cropped(const fsm::Image& image, int left, int top, int width, int height);

/// The picture set upright; `orientation` as in EXIF, 1..8, where 1 is as it is.
fsm::Image Turned(const fsm::Image& image, int orientation);

}  // namespace facefit
