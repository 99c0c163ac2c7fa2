#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "vdm/features/fourier.h"

namespace vdm {

/// 13 mel cepstra of a window of 410 samples as the front end of Sphinx computes them for its
/// en-us model (feat.params there: 25 filters from 130 to 6800 Hz, rounded to bins and of equal
/// area; DCT-II; lifter 22; pre-emphasis 0.97; Hamming; less the window's mean). tests/vdm compares
/// them with sphinxbase's.
class SpeechCepstra {
 public:
  static constexpr std::size_t kWindow = 410, kCount = 13, kFilters = 25;
  /// `warp`: see MakeFeatures.
  explicit SpeechCepstra(float warp = 1);
  /// `before`: the sample before the window. REQUIRES: kWindow samples.
  std::array<float, kCount> Of(float before, std::span<const std::int16_t> window) const;

 private:
  struct Filter {
    std::size_t first = 0;
    std::vector<float> weights;
  };
  std::array<float, kWindow> window_;
  std::array<Filter, kFilters> filters_;
  std::array<std::array<float, kFilters>, kCount> transform_;
  Fourier512 fourier_;
};

}  // namespace vdm
