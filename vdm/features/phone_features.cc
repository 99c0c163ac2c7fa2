#include "vdm/features/phone_features.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vdm {
namespace {

using Cepstra = CepstraMean::Cepstra;

// feat.params of the model, cmninit; the first is the level's.
constexpr Cepstra kUsual = {41.00F, -5.29F, -0.12F, 5.09F,  2.48F,  -4.07F, -1.37F,
                            -1.78F, -5.08F, -2.05F, -6.45F, -1.42F, 1.17F};
constexpr float kBelowPeak = 24;       // the mean's level below the peak
constexpr float kPeakFalls = 0.0125F;  // a frame; as in the LevelNormaliser, in the units of c0
constexpr float kPrior = 60, kMemory = 500;  // frames
// Frames and numbers that hang together make likelihoods far too sure; so much of their logarithm
// gave the least cross-entropy of the classes of sounds (voice rms and a person reading prompts).
constexpr float kSoftness = 0.5F;
const float kLeast = std::exp(-7.0F);
constexpr float kScale = 3.5F;

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

float PhoneFeatures::Likelihood(float number) { return std::exp((number - 1) * kScale); }

PhoneFeatures::PhoneFeatures(float warp, std::shared_ptr<const PhoneModel> model)
    : model_(std::move(model)), mel_(warp) {
  assert(model_->phones().size() == kPhones);
  phones_.resize(kLate);
}

void PhoneFeatures::AddCepstra(const Cepstra& cepstra) {
  around_.push_back(cepstra);
  while (around_.size() < kSpan - kReach) around_.push_front(cepstra);
  if (around_.size() > kSpan) around_.pop_front();
  if (around_.size() < kSpan) return;
  // Of the frame in the middle: the features 1s_c_d_dd of Sphinx.
  const auto at = [&](std::size_t frame, std::size_t i) { return around_[frame][i]; };
  for (std::size_t i = 0; i < SpeechCepstra::kCount; ++i) pending_.push_back(at(3, i));
  for (std::size_t i = 0; i < SpeechCepstra::kCount; ++i) {
    pending_.push_back(at(5, i) - at(1, i));
  }
  for (std::size_t i = 0; i < SpeechCepstra::kCount; ++i) {
    pending_.push_back((at(6, i) - at(2, i)) - (at(4, i) - at(0, i)));
  }
}

void PhoneFeatures::ScorePending() {
  constexpr auto kRows = static_cast<Eigen::Index>(PhoneModel::kFeatures);
  const Eigen::MatrixXf states = model_->Score(Eigen::Map<const Eigen::MatrixXf>(
      pending_.data(), kRows, static_cast<Eigen::Index>(pending_.size()) / kRows));
  pending_.clear();
  for (Eigen::Index frame = 0; frame < states.cols(); ++frame) {
    // In a vector of its own: the same place in memory gives the same rounding.
    Eigen::VectorXf likely = (states.col(frame).array() - states.col(frame).maxCoeff()) * kSoftness;
    likely = likely.array().exp().eval();
    const float sum = likely.sum();
    Phones phones;
    for (std::size_t p = 0; p < kPhones; ++p) {
      const float phone = likely.segment<3>(static_cast<Eigen::Index>(3 * p)).sum() / sum;
      phones[p] = std::log(phone + kLeast) / kScale + 1;
    }
    phones_.push_back(phones);
  }
}

void PhoneFeatures::Add(std::span<const std::int16_t> samples, std::vector<float>& vectors) {
  framer_.Add(samples, [&](std::span<const std::int16_t> sound) {
    AddCepstra(mean_.Without(
        cepstra_.Of(static_cast<float>(sound[0]), sound.subspan(1, SpeechCepstra::kWindow))));
  });
  ScorePending();
  mel_vectors_.clear();
  mel_.Add(samples, mel_vectors_);
  for (std::size_t at = 0; at < mel_vectors_.size(); at += LevelNormaliser::kSize) {
    const auto mel = mel_vectors_.begin() + static_cast<std::ptrdiff_t>(at);
    vectors.insert(vectors.end(), mel, mel + LevelNormaliser::kSize);
    vectors.insert(vectors.end(), phones_.front().begin(), phones_.front().end());
    phones_.pop_front();
  }
}

}  // namespace vdm
