#pragma once

#include <array>
#include <vector>

#include "vdm/features/fourier.h"
#include "vdm/features/framer.h"
#include "vdm/features/level_normaliser.h"
#include "vdm/features/sound_features.h"

namespace vdm {

/// 24 triangular bands from 80 to 7200 Hz, equally wide in mel (m = 1127 ln(1 + f/700)), of windows
/// of 20 ms (Hann) each 10 ms; their log energies go through the LevelNormaliser.
class MelFeatures final : public SoundFeatures {
 public:
  explicit MelFeatures(float warp);
  std::size_t size() const override { return LevelNormaliser::kSize; }
  std::size_t hop_samples() const override { return kHop; }
  std::size_t ahead_samples() const override { return kWindow / 2; }
  void Add(std::span<const std::int16_t> samples, std::vector<float>& vectors) override;

 private:
  static constexpr std::size_t kWindow = 320, kHop = 160;
  struct Band {
    std::size_t first = 0;
    std::vector<float> weights;
  };
  std::array<float, kWindow> window_;
  std::array<Band, LevelNormaliser::kBands> bands_;
  Fourier512 fourier_;
  Framer framer_{kWindow, kHop};
  LevelNormaliser normaliser_;
};

}  // namespace vdm
