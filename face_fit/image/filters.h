#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <utility>
#include <vector>

#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

// Filters of images. OpenCV (core and imgproc) does the work; only filters.cc includes it.
// All are pure and run on the caller's thread. REQUIRES: images of at least one pixel.

/// Returns the mean over squares of `2 * reach + 1` pixels, at the edges over the part within the
/// image. For FloatImage, VectorImage and Raster<glm::mat3>.
template <typename T>
Raster<T> Blurred(const Raster<T>& image, int reach);

/// Means of values by weight over the squares of Blurred (normalised convolution; Knutsson and
/// Westin 1993). For FloatImage and VectorImage.
template <typename T>
struct WeightedBlur {
  /// Blurs as often as `passes` says.
  WeightedBlur(Raster<T> values, const Mask& weights, int reach, int passes = 1)
      : sum(std::move(values)), weight(weights) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] *= weights[i];
    for (int pass = 0; pass < passes; ++pass) {
      sum = Blurred(sum, reach);
      weight = Blurred(weight, reach);
    }
  }
  /// Returns the mean around a pixel, or nearly 0 where next to nothing has weight.
  T MeanAt(std::size_t i) const { return sum[i] / std::max(weight[i], 1e-3F); }

  Raster<T> sum;  ///< means of values times weights
  Mask weight;    ///< mean weights
};

/// Returns the morphological closing of each channel by squares of `2 * reach + 1` pixels (Serra
/// 1982): fills dark spots that no such square fits into.
VectorImage Closed(const VectorImage& image, int reach);

/// Inpaints pixels of low weight with the colours around them, averaged over a wider area the
/// farther they are (push and pull through a pyramid of halved images; Gortler, Grzeszczuk,
/// Szeliski and Cohen, The Lumigraph, 1996). Pixels of full weight stay. `weight`: 0..1, as large
/// as `image`.
void PushPullInpaint(fsm::Image& image, const Mask& weight);

/// Sets positive pixels and every hole in them to 1, and the rest to 0. Holes are 0s that no path
/// of four-neighbours connects to the image's edge.
void FillHoles(Mask& image);

/// Sets pixels to 0 that no path of eight-neighbours of at least 0.1 connects to the pixel `to`.
/// Does nothing if that pixel is less. A pixel outside stands for the nearest one inside.
void KeepConnected(glm::ivec2 to, Mask& image);

/// Returns for each pixel the index of the nearest one that is at least `threshold`, possibly its
/// own. Distances are accurate to about 2 %, so of two nearly equal ones either may be returned.
/// REQUIRES: there is such a pixel.
std::vector<std::size_t> NearestAbove(const FloatImage& image, float threshold);

/// Returns the distance of a pixel outside a closed line, negative inside.
float SignedDistance(std::span<const glm::vec2> outline, glm::vec2 pixel);

/// Scales an image down; each pixel is the mean of those it covers. For FloatImage and
/// VectorImage. REQUIRES: 1 <= width <= image.width, likewise height.
template <typename T>
Raster<T> ScaledDown(const Raster<T>& image, int width, int height);

/// Returns the image, scaled down if its longer side exceeds `most_size` pixels.
fsm::Image ScaledToFit(fsm::Image image, int most_size);

/// Returns `width` x `height` pixels from (left, top). REQUIRES: they lie within the image.
fsm::Image Cropped(const fsm::Image& image, int left, int top, int width, int height);

/// Returns the image set upright; `orientation`: EXIF's 1..8, where 1 is upright.
fsm::Image OrientedByExif(const fsm::Image& image, int orientation);

}  // namespace facefit
