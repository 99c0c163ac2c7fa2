#pragma once

#include <array>
#include <deque>
#include <memory>

#include "vdm/features/framer.h"
#include "vdm/features/mel_features.h"
#include "vdm/features/phone_model.h"
#include "vdm/features/speech_cepstra.h"

namespace vdm {

/// Takes the mean out of cepstra on the fly, as the phone model expects it. The mean starts from
/// the model's own (feat.params, cmninit), its level relative to the sound's peak, and moves to the
/// sound's own with kMemory frames of memory.
class CepstraMean {
 public:
  using Cepstra = std::array<float, SpeechCepstra::kCount>;
  Cepstra Without(const Cepstra& cepstra);

 private:
  Cepstra sums_{};
  float weight_ = 0;
  float peak_ = -1e9F;
};

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
  static constexpr std::size_t kReach = 3;  // frames that the differences need on each side
  static constexpr std::size_t kSpan = 2 * kReach + 1;
  using Phones = std::array<float, kPhones>;
  void AddCepstra(const CepstraMean::Cepstra& cepstra);
  void ScorePending();

  const std::shared_ptr<const PhoneModel> model_;
  MelFeatures mel_;
  SpeechCepstra cepstra_;
  Framer framer_{SpeechCepstra::kWindow + 2, 160};
  CepstraMean mean_;
  std::deque<CepstraMean::Cepstra> around_;  // the last kSpan
  std::vector<float> pending_;               // features to be scored, kFeatures a frame
  std::deque<Phones> phones_;                // not yet told
  std::vector<float> mel_vectors_;
};

}  // namespace vdm
