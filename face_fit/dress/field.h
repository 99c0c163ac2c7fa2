#pragma once

#include <vector>

#include "face_fit/picture/photo.h"

namespace facefit {

/// A number for each pixel of a picture.
struct FloatImage {
  int width = 0, height = 0;
  std::vector<float> at;
  FloatImage(int w, int h, float value = 0)
      : width(w), height(h), at(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), value) {}
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  /// Between the pixels, whose centres lie at .5; the edge goes on outside.
  float Between(float x, float y) const;
};

/// The mean over squares of side 2 * reach + 1.
FloatImage Blurred(const FloatImage& field, int reach);
/// Fills what has no weight from around it, farther away from ever wider around (a pyramid of
/// halved pictures); full weight stays as it is.
void PushPullInpaint(fsm::Image& image, const FloatImage& weight);

}  // namespace facefit
