#include "vdm/features/phone_features.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vdm {
namespace {

// Frames and numbers that hang together make likelihoods far too sure; so much of their logarithm
// gave the least cross-entropy of the classes of sounds (voice rms and a person reading prompts).
constexpr float kSoftness = 0.5F;
const float kLeast = std::exp(-7.0F);
constexpr float kScale = 3.5F;

}  // namespace

float PhoneFeatures::Likelihood(float number) { return std::exp((number - 1) * kScale); }

PhoneFeatures::PhoneFeatures(float warp, std::shared_ptr<const PhoneModel> model)
    : model_(std::move(model)), mel_(warp) {
  assert(model_->phones().size() == kPhones);
  phones_.resize(kLate);
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
  frames_.Add(samples, pending_);
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
