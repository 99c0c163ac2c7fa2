#pragma once

#include <array>
#include <deque>
#include <memory>

#include "vdm/features/mel_features.h"
#include "vdm/features/phone_model.h"
#include "vdm/features/speech_frames.h"

namespace vdm {

/// The vectors of MelFeatures, and behind each the likelihoods of the phones kLate frames before,
/// which is as far ahead as the model's differences over time let it see within the same sound:
/// log(p + kLeast), p softened, scaled to about -1 .. 1.
class PhoneFeatures final : public SoundFeatures {
 public:
  static constexpr std::size_t kLate = 4;
  /// Phones of the en-us model; another's cannot be used with a network made for it.
  static constexpr std::size_t kPhones = 42;
  static constexpr std::size_t kSize = LevelNormaliser::kSize + kPhones;
  /// How likely the phone of such a number is, at least exp(-7).
  static float Likelihood(float number);
  /// REQUIRES: `model` has kPhones phones.
  PhoneFeatures(float warp, std::shared_ptr<const PhoneModel> model);
  std::size_t size() const override { return kSize; }
  std::size_t hop_samples() const override { return mel_.hop_samples(); }
  std::size_t ahead_samples() const override { return mel_.ahead_samples(); }
  void Add(std::span<const std::int16_t> samples, std::vector<float>& vectors) override;

 private:
  using Phones = std::array<float, kPhones>;
  void ScorePending();

  const std::shared_ptr<const PhoneModel> model_;
  MelFeatures mel_;
  SpeechFrames frames_;
  std::vector<float> pending_;  // to be scored
  std::deque<Phones> phones_;   // not yet told
  std::vector<float> mel_vectors_;
};

}  // namespace vdm
