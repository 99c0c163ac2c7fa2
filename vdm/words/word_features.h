#pragma once

#include <memory>

#include "vdm/features/phone_features.h"
#include "vdm/words/word_decoder.h"

namespace vdm {

/// What a WordDecoder says each 10 ms: how likely each phone is now, 20, 40 and 70 ms ago, and how
/// likely to come next within its word.
class WordFeatures final : public SoundFeatures {
 public:
  static constexpr std::array<std::size_t, 4> kBacks = {0, 2, 4, 7};
  static constexpr std::size_t kSize = (kBacks.size() + 1) * PhoneFeatures::kPhones;
  /// REQUIRES: the tree's model has kPhones phones.
  explicit WordFeatures(std::shared_ptr<const WordTree> tree);
  std::size_t size() const override { return kSize; }
  std::size_t hop_samples() const override { return kHop; }
  std::size_t ahead_samples() const override;
  void Add(std::span<const std::int16_t> samples, std::vector<float>& vectors) override;

 private:
  static constexpr std::size_t kHop = 160;
  // Two frames behind this one are then within 60 ms.
  static constexpr std::size_t kEarly = 48;
  const std::shared_ptr<const WordTree> tree_;
  SpeechFrames frames_{kEarly};
  WordDecoder decoder_;
  std::vector<float> heard_;
};

}  // namespace vdm
