#include "vdm/words/word_features.h"

#include <utility>

namespace vdm {

WordFeatures::WordFeatures(std::shared_ptr<const WordTree> tree)
    : tree_(std::move(tree)), decoder_(*tree_) {}

std::size_t WordFeatures::ahead_samples() const {
  return SpeechFrames::kReach * kHop + SpeechCepstra::kWindow / 2 + 1 - kEarly;
}

void WordFeatures::Add(std::span<const std::int16_t> samples, std::vector<float>& vectors) {
  constexpr std::size_t kPhones = PhoneFeatures::kPhones;
  heard_.clear();
  frames_.Add(samples, heard_);
  for (std::size_t at = 0; at < heard_.size(); at += PhoneModel::kFeatures) {
    decoder_.Add(&heard_[at]);
    vectors.resize(vectors.size() + kSize);
    std::span<float> vector = std::span(vectors).last(kSize);
    for (const std::size_t back : kBacks) {
      decoder_.Phones(back, vector.first(kPhones));
      vector = vector.subspan(kPhones);
    }
    decoder_.NextPhones(vector);
  }
}

}  // namespace vdm
