#pragma once

#include <cstddef>
#include <cstdint>

#include "fsm/image/image.h"

namespace fsm {

/// Samples along each side of a pixel.
inline constexpr int kSamplesAlong = 2;

/// Rows of RGBA8 samples as GL returns them, lowest first.
struct SampleRows {
  const std::uint32_t* first;
  std::size_t row;  ///< samples in each row
  int from, to;     ///< index of first and last row in the framebuffer
};

enum class Filter {
  kBox,  ///< averages the 2 x 2 samples of a pixel
  /// Averages over 4 x 4 samples with less weight on the outer ones, as a camera does, so that
  /// nearly horizontal edges show no stairs.
  kSoft
};

/// Averages the samples of `rows` rows of pixels, counted from below, beginning with `first`, into
/// 4 bytes for each pixel, upper row first. Filter::kSoft also uses one row of samples
/// below and above, where `samples` has them.
void AverageSamples(const SampleRows& samples, int first, int rows, Filter filter,
                    std::uint8_t* rgba);

/// Divides colours by their opacity: blending and averaging over transparent black leave them
/// premultiplied, but picture files expect them straight.
void Unmultiply(Image& image);

}  // namespace fsm
