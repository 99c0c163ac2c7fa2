#include "vdm/features/speech_frames.h"

#include <algorithm>

namespace vdm {
namespace {

using Cepstra = CepstraMean::Cepstra;

// feat.params of the model, cmninit; the first is the level's.
constexpr Cepstra kUsual = {41.00F, -5.29F, -0.12F, 5.09F,  2.48F,  -4.07F, -1.37F,
                            -1.78F, -5.08F, -2.05F, -6.45F, -1.42F, 1.17F};
constexpr float kBelowPeak = 24;       // the mean's level below the peak
constexpr float kPeakFalls = 0.0125F;  // a frame; as in the LevelNormaliser, in the units of c0
constexpr float kPrior = 60, kMemory = 500;  // frames

}  // namespace

Cepstra CepstraMean::Without(const Cepstra& cepstra) {
  const float level = cepstra[0];
  peak_ = level > peak_
              ? (peak_ < -1e8F ? std::max(level, kUsual[0]) : peak_ + 0.3F * (level - peak_))
              : peak_ - kPeakFalls;
  const float keeps = 1 - 1 / kMemory;
  weight_ = weight_ * keeps + 1;
  Cepstra out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float here = i == 0 ? peak_ : 0;  // a level is one below the peak
    sums_[i] = sums_[i] * keeps + cepstra[i] - here;
    const float usual = i == 0 ? -kBelowPeak : kUsual[i];
    out[i] = cepstra[i] - here - (sums_[i] + kPrior * usual) / (weight_ + kPrior);
  }
  return out;
}

SpeechFrames::SpeechFrames(std::size_t early) : framer_(SpeechCepstra::kWindow + 2, 160, early) {}

void SpeechFrames::Add(std::span<const std::int16_t> samples, std::vector<float>& frames) {
  framer_.Add(samples, [&](std::span<const std::int16_t> sound) {
    AddCepstra(mean_.Without(cepstra_.Of(static_cast<float>(sound[0]),
                                         sound.subspan(1, SpeechCepstra::kWindow))),
               frames);
  });
}

void SpeechFrames::AddCepstra(const Cepstra& cepstra, std::vector<float>& frames) {
  around_.push_back(cepstra);
  while (around_.size() < kSpan - kReach) around_.push_front(cepstra);
  if (around_.size() > kSpan) around_.pop_front();
  if (around_.size() < kSpan) return;
  // Of the frame in the middle: the features 1s_c_d_dd of Sphinx.
  const auto at = [&](std::size_t frame, std::size_t i) { return around_[frame][i]; };
  for (std::size_t i = 0; i < SpeechCepstra::kCount; ++i) frames.push_back(at(3, i));
  for (std::size_t i = 0; i < SpeechCepstra::kCount; ++i) {
    frames.push_back(at(5, i) - at(1, i));
  }
  for (std::size_t i = 0; i < SpeechCepstra::kCount; ++i) {
    frames.push_back((at(6, i) - at(2, i)) - (at(4, i) - at(0, i)));
  }
}

}  // namespace vdm
