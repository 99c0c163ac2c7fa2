#pragma once

#include <array>
#include <vector>

#include "vdm/features/framer.h"
#include "vdm/features/sound_features.h"

namespace vdm {

/// 20 cepstra of linear prediction, the speech parameters of the papers' voice-driven mouth: one
/// window of 32 ms (Hamming) each 32 ms. Order 20 by the autocorrelation method (Levinson and
/// Durbin), cepstra c_n = a_n + sum_{k<n} (k/n) c_k a_{n-k} (Atal, JASA 55, 1974). Each is given in
/// units of about its deviation; the first number is the level instead of c_0.
class CepstraFeatures final : public SoundFeatures {
 public:
  static constexpr std::size_t kOrder = 20;
  CepstraFeatures();
  std::size_t size() const override { return kOrder; }
  std::size_t hop_samples() const override { return kWindow; }
  std::size_t ahead_samples() const override { return kWindow / 2; }
  void Add(std::span<const std::int16_t> samples, std::vector<float>& vectors) override;

 private:
  static constexpr std::size_t kWindow = 512;
  std::array<double, kWindow> window_;
  Framer framer_{kWindow, kWindow};
};

}  // namespace vdm
