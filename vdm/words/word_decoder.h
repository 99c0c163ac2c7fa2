#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vdm/words/word_tree.h"

namespace vdm {

/// Which phones are being said, so far as words of English could be: the likeliest ways through a
/// WordTree, one word behind the other, in step with the sound (Viterbi search in a beam). How
/// likely a word is does not depend on the one before. Lifetime: the tree outlives it. Thread: none
/// of its own; one instance, one thread.
class WordDecoder {
 public:
  /// How many frames back it says what phone it was.
  static constexpr std::size_t kBack = 8;
  explicit WordDecoder(const WordTree& tree);

  /// A frame of PhoneModel::kFeatures numbers.
  void Add(const float* features);
  /// How likely each phone was so many frames ago, judged by all that came since. REQUIRES: `back`
  /// < kBack; as many numbers as the model has phones.
  void Phones(std::size_t back, std::span<float> likely) const;
  /// Likewise, how likely each is to be the next within its word; the rest is words that end.
  void NextPhones(std::span<float> likely) const;

 private:
  static constexpr std::size_t kStates = PhoneModel::kStates;
  /// The best way into each state of a node. `phones`: of the last kBack frames, a byte each.
  struct Path {
    std::uint32_t node = 0;
    ContextModel::Phone left = 0;
    std::array<float, kStates> scores{};
    std::array<std::uint64_t, kStates> phones{};
    float entry = 0;  // of who comes in with the next frame
    std::uint64_t entry_phones = 0;
    ContextModel::Phone entry_left = 0;
  };
  /// A word, pause or noise that ends.
  struct End {
    float score = 0;
    std::uint64_t phones = 0;
    ContextModel::Phone last = 0;
    bool pause = false;
  };
  void Enter(std::uint32_t node, float score, std::uint64_t phones, ContextModel::Phone left);
  void EnterWords(const End& end);
  void Step(const float* features);
  float Likely(const Path& path, std::size_t state);
  float Prune();
  void Leave(const Path& path);
  void Weigh();
  bool IsPause(std::uint32_t node) const { return node >= tree_.nodes().size(); }
  ContextModel::Phone PhoneOf(std::uint32_t node) const {
    return IsPause(node) ? pauses_[node - tree_.nodes().size()] : tree_.nodes()[node].phone;
  }

  const WordTree& tree_;
  ContextScorer scorer_;
  std::vector<ContextModel::Phone> pauses_;  // silence first, then noises: nodes behind the tree's
  ContextModel::Phone silence_ = 0;
  std::vector<Path> paths_, next_;
  std::vector<std::uint32_t> place_;  // of a node in next_, plus 1; 0: not there
  std::vector<End> ends_;
  std::vector<float> acoustic_, best_;
  std::vector<float> shares_;  // of the states of paths_
  std::vector<std::array<float, kStates>> ending_scores_;
  std::vector<std::uint32_t> ending_frame_;
  std::uint32_t frame_ = 0;
  float least_ = 0;  // score below which nobody comes in
};

}  // namespace vdm
