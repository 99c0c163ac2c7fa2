#pragma once

#include <array>
#include <deque>
#include <span>
#include <vector>

#include "vdm/features/framer.h"
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

/// What PhoneModel looks at, each 10 ms: the features 1s_c_d_dd of Sphinx, PhoneModel::kFeatures
/// numbers, of 16 kHz mono in pieces of any size. Thread: none of its own; one instance, one
/// thread.
class SpeechFrames {
 public:
  static constexpr std::size_t kReach = 3;  ///< frames that the differences need on each side
  /// `early`: frames stand for so many samples before.
  explicit SpeechFrames(std::size_t early = 0);
  /// Appends the frames that became complete.
  void Add(std::span<const std::int16_t> samples, std::vector<float>& frames);

 private:
  static constexpr std::size_t kSpan = 2 * kReach + 1;
  void AddCepstra(const CepstraMean::Cepstra& cepstra, std::vector<float>& frames);

  SpeechCepstra cepstra_;
  Framer framer_;
  CepstraMean mean_;
  std::deque<CepstraMean::Cepstra> around_;  // the last kSpan
};

}  // namespace vdm
