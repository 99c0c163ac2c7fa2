#pragma once

#include <cstddef>
#include <cstdint>

#include "fsm/image/image.h"

namespace fsm {

/// Samples along each side of a pixel.
inline constexpr int kSamplesAlong = 2;

/// Rows of RGBA8 samples as GL hands them out, the lowest first.
struct SampleRows {
  const std::uint32_t* first;
  std::size_t row;  ///< samples in each
  int from, to;     ///< which rows of the target these are, both included
};

/// The averages of the samples of `rows` rows of pixels from the `first` on, counted from below,
/// into 4 bytes each, the upper row first. `soft`: over 4 x 4 samples, the outer ones in part, as a
/// camera would; edges that are nearly level then do not look like stairs. It takes one row of
/// samples below and above, too, where `samples` has them.
void AverageSamples(const SampleRows& samples, int first, int rows, bool soft, std::uint8_t* rgba);

/// Blending and averaging over transparent black leave colours already multiplied by their opacity;
/// picture files want them whole.
void Unmultiply(Image& image);

}  // namespace fsm
