#include "vdm/words/word_decoder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace vdm {
namespace {

using Phone = ContextModel::Phone;

// Frames that overlap hang together: so much of the logarithm of their likelihood counts, and so
// much of that of words.
constexpr float kSoftness = 0.25F, kWordShare = 0.8F;
constexpr float kWordCost = -1, kPauseCost = -1, kNoiseCost = -8;
// A state lasts two frames on the mean.
const float kStay = std::log(0.5F), kGoOn = std::log(0.5F);
// What is followed: paths so near to the best, at most so many, and the likeliest words that end.
constexpr float kBeam = 12;
constexpr std::size_t kMostPaths = 300, kMostEnds = 25;
constexpr float kNever = WordTree::kNever;

float BestOf(const std::array<float, PhoneModel::kStates>& scores) {
  return *std::ranges::max_element(scores);
}

}  // namespace

WordDecoder::WordDecoder(const WordTree& tree) : tree_(tree), scorer_(tree.contexts()) {
  const auto& names = tree.contexts().phones().phones();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto phone = static_cast<Phone>(i);
    if (names[i] == "SIL") {
      silence_ = phone;
      pauses_.insert(pauses_.begin(), phone);
    } else if (names[i].starts_with('+')) {
      pauses_.push_back(phone);
    }
  }
  place_.resize(tree.nodes().size() + pauses_.size());
  ending_scores_.resize(tree.endings().size());
  ending_frame_.resize(tree.endings().size());
  least_ = kNever;
  EnterWords({.last = silence_});
  paths_.swap(next_);
  for (const Path& path : paths_) place_[path.node] = 0;
  Weigh();
}

void WordDecoder::Enter(std::uint32_t node, float score, std::uint64_t phones, Phone left) {
  if (score < least_) return;
  if (place_[node] == 0) {
    next_.push_back({.node = node, .left = left, .entry = kNever});
    next_.back().scores.fill(kNever);
    place_[node] = static_cast<std::uint32_t>(next_.size());
  }
  Path& path = next_[place_[node] - 1];
  if (score <= path.entry) return;
  path.entry = score;
  path.entry_phones = phones;
  path.entry_left = left;
}

void WordDecoder::EnterWords(const End& end) {
  for (std::uint32_t root = 0; root < tree_.roots(); ++root) {
    Enter(root, end.score + kWordShare * tree_.nodes()[root].likely, end.phones, end.last);
  }
  if (end.pause) return;
  for (std::size_t i = 0; i < pauses_.size(); ++i) {
    Enter(static_cast<std::uint32_t>(tree_.nodes().size() + i),
          end.score + (pauses_[i] == silence_ ? kPauseCost : kNoiseCost), end.phones, end.last);
  }
}

float WordDecoder::Likely(const Path& path, std::size_t state) {
  if (IsPause(path.node)) {
    return scorer_.Of(tree_.contexts().SequenceOf(PhoneOf(path.node)), state);
  }
  const WordTree::Node& node = tree_.nodes()[path.node];
  if (node.next != WordTree::kNone) {
    return scorer_.Of(node.begins ? tree_.BeginningOf(path.node, path.left) : node.states, state);
  }
  const WordTree::Ending& ending =
      node.begins ? tree_.SingleEnding(node.phone, path.left) : tree_.endings()[node.states];
  const auto index = static_cast<std::size_t>(&ending - tree_.endings().data());
  if (ending_frame_[index] != frame_) {
    ending_frame_[index] = frame_;
    for (std::size_t s = 0; s < kStates; ++s) {
      float best = kNever;
      for (const auto sequence : ending.sequences) best = std::max(best, scorer_.Of(sequence, s));
      ending_scores_[index][s] = best;
    }
  }
  return ending_scores_[index][state];
}

/// One frame more for all paths.
void WordDecoder::Step(const float* features) {
  ++frame_;
  scorer_.Begin(features);
  acoustic_.resize(paths_.size() * kStates);
  float most = kNever;
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    Path& path = paths_[i];
    if (path.entry > BestOf(path.scores)) path.left = path.entry_left;
    for (std::size_t s = 0; s < kStates; ++s) {
      const float likely = Likely(path, s);
      acoustic_[i * kStates + s] = likely;
      most = std::max(most, likely);
    }
  }
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    Path& path = paths_[i];
    const std::uint64_t phone = PhoneOf(path.node);
    for (std::size_t s = kStates; s-- > 0;) {
      const float come = s > 0 ? path.scores[s - 1] + kGoOn : path.entry;
      const std::uint64_t with = s > 0 ? path.phones[s - 1] : path.entry_phones;
      const float stay = path.scores[s] + kStay;
      path.phones[s] = ((come > stay ? with : path.phones[s]) << 8) | phone;
      path.scores[s] = std::max(come, stay) + kSoftness * (acoustic_[i * kStates + s] - most);
    }
    path.entry = kNever;
  }
}

/// Leaves the best paths, the best one with a score of 0; returns the least of theirs.
float WordDecoder::Prune() {
  best_.clear();
  for (const Path& path : paths_) best_.push_back(BestOf(path.scores));
  const float best = *std::ranges::max_element(best_);
  float least = best - kBeam;
  if (best_.size() > kMostPaths) {
    const auto last = best_.begin() + kMostPaths - 1;
    std::nth_element(best_.begin(), last, best_.end(), std::greater<>());
    least = std::max(least, *last);
  }
  std::erase_if(paths_, [&](const Path& path) { return BestOf(path.scores) < least; });
  for (Path& path : paths_) {
    for (float& score : path.scores) score -= best;
  }
  return least - best;
}

/// To the phones, words and pauses that may follow.
void WordDecoder::Leave(const Path& path) {
  const float score = path.scores.back() + kGoOn;
  if (score < least_) return;
  const Phone phone = PhoneOf(path.node);
  const std::uint64_t phones = path.phones.back();
  if (IsPause(path.node)) {
    ends_.push_back({score, phones, silence_, true});
    return;
  }
  const WordTree::Node& node = tree_.nodes()[path.node];
  for (std::uint32_t child = node.first_child; child < node.first_child + node.children; ++child) {
    Enter(child, score + kWordShare * (tree_.nodes()[child].likely - node.likely), phones, phone);
  }
  if (node.word > kNever) {
    ends_.push_back(
        {score + kWordShare * (node.word - node.likely) + kWordCost, phones, phone, false});
  }
}

void WordDecoder::Add(const float* features) {
  Step(features);
  least_ = Prune();
  next_.assign(paths_.begin(), paths_.end());
  for (std::size_t i = 0; i < next_.size(); ++i) {
    place_[next_[i].node] = static_cast<std::uint32_t>(i + 1);
  }
  ends_.clear();
  for (const Path& path : paths_) Leave(path);
  std::ranges::sort(ends_, std::greater<>(), &End::score);
  if (ends_.size() > kMostEnds) ends_.resize(kMostEnds);
  for (const End& end : ends_) EnterWords(end);
  for (const Path& path : next_) place_[path.node] = 0;
  paths_.swap(next_);
  Weigh();
}

/// The share of each state of each path.
void WordDecoder::Weigh() {
  shares_.clear();
  float sum = 0;
  for (const Path& path : paths_) {
    for (const float score : path.scores) {
      shares_.push_back(std::exp(score));
      sum += shares_.back();
    }
  }
  for (float& share : shares_) share /= sum;
}

void WordDecoder::Phones(std::size_t back, std::span<float> likely) const {
  std::ranges::fill(likely, 0.0F);
  auto share = shares_.begin();
  for (const Path& path : paths_) {
    for (const std::uint64_t phones : path.phones)
      likely[(phones >> (8 * back)) & 0xFF] += *share++;
  }
}

void WordDecoder::NextPhones(std::span<float> likely) const {
  std::ranges::fill(likely, 0.0F);
  auto share = shares_.begin();
  for (const Path& path : paths_) {
    const float sum = std::accumulate(share, share + kStates, 0.0F);
    share += kStates;
    if (IsPause(path.node)) continue;
    const Phone next = tree_.nodes()[path.node].next;
    if (next != WordTree::kNone) likely[next] += sum;
  }
}

}  // namespace vdm
