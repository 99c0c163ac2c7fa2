#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "vdm/words/context_model.h"

namespace vdm {

/// The words of English as a tree of their phones, each node a phone of all words that begin with
/// the same phones up to the one after it. A value, constant once read; some 6 MB. Thread: const
/// calls may run at once.
class WordTree {
 public:
  static constexpr ContextModel::Phone kNone = 255;
  static constexpr float kNever = -std::numeric_limits<float>::infinity();
  struct Node {
    ContextModel::Phone phone = 0;
    ContextModel::Phone next = kNone;  ///< phone; kNone: the word ends
    bool begins = false;               ///< a word's first phone
    /// Its states; for a last phone an index of endings(), unless the word begins here, too.
    std::uint16_t states = 0;
    float likely = kNever;  ///< ln of the likeliest word that goes through it
    float word = kNever;    ///< ln of the likeliest word that ends here
    std::uint32_t first_child = 0, children = 0;
  };

  /// `dictionary`: WORD PHONE... in lines (cmudict); `likelihoods`: see ReadWordLikelihoods, words
  /// that it lacks are left out. Errors: kUnavailable, kBadValue "FILE:LINE: ...".
  static vm::Result<std::shared_ptr<const WordTree>> Read(
      const std::string& dictionary, const std::string& likelihoods,
      std::shared_ptr<const ContextModel> contexts);

  const ContextModel& contexts() const { return *contexts_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  /// The first phones of words are the first nodes.
  std::size_t roots() const { return roots_; }
  /// The states of a first phone behind a word that ends with `left`. REQUIRES: `root` < roots(),
  /// with a phone after it.
  ContextModel::Sequence BeginningOf(std::size_t root, ContextModel::Phone left) const {
    return beginnings_[root * contexts_->phones().phones().size() + left];
  }
  /// The states a last phone may have before other words. `sequences`: each once.
  struct Ending {
    std::vector<ContextModel::Sequence> sequences{};
  };
  const std::vector<Ending>& endings() const { return endings_; }
  /// Of a word of one phone behind another.
  const Ending& SingleEnding(ContextModel::Phone phone, ContextModel::Phone left) const;

 private:
  class Builder;
  std::shared_ptr<const ContextModel> contexts_;
  std::vector<Node> nodes_;
  std::size_t roots_ = 0;
  std::vector<ContextModel::Sequence> beginnings_;  // by root and left
  std::vector<Ending> endings_;
  std::vector<std::uint16_t> single_;  // by phone and left, an index of endings_
};

/// The words of Debian's pocketsphinx-en-us, read when first asked for.
const vm::Result<std::shared_ptr<const WordTree>>& InstalledWordTree();

}  // namespace vdm
