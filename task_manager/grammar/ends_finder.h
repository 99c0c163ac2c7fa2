#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>
#include <vector>

#include "task_manager/grammar/model.h"

namespace vxml::srgs {

using Ends = std::vector<std::size_t>;  ///< places in the input, sorted, each once

bool Holds(const Ends& ends, std::size_t end);
void InsertEnd(Ends& ends, std::size_t end);

/// Finds where each expansion may end from each place of one input; every answer is kept.
/// Limits: kMaxSteps (matcher.h) and kMaxDepth; beyond them over_limit() is true and answers are
/// not to be used. Thread: one instance, one thread.
class EndsFinder {
 public:
  /// `split_digits`: figures and words need no blank between them.
  EndsFinder(const std::string& input, bool dtmf, bool split_digits);

  const std::string& text() const { return text_; }  ///< the input as it is compared
  bool over_limit() const { return over_limit_; }
  /// Some token reached the end of the input: a longer input might match.
  bool touched_end() const { return touched_end_; }

  /// The answer is valid until the next call.
  const Ends& OfRule(const Rule& rule, std::size_t at);
  const Ends& OfNode(const Expansion& node, std::size_t at);
  /// Where `child` may end if it begins at one of `from`.
  Ends Step(const Expansion& child, const Ends& from);
  /// Places reached after 0, 1, 2 ... turns of a repeat. Turns beyond its least must take
  /// something.
  std::vector<Ends> Layers(const Expansion& repeat, std::size_t at);
  std::size_t SkipBlank(std::size_t at) const;

  /// Counts one step of work. False: over the limits.
  bool Spend();
  void Enter() { ++depth_; }
  void Leave() { --depth_; }

 private:
  struct Key {
    const void* node;
    std::size_t at;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      return std::hash<const void*>()(key.node) * 1000003U + key.at;
    }
  };
  static constexpr int kMaxDepth = 4000;

  Ends Compute(const Expansion& node, std::size_t at);
  Ends OfToken(const Expansion& node, std::size_t at);
  Ends OfGarbage(std::size_t at);
  bool AtWordEnd(std::size_t at) const;

  std::string text_;
  bool dtmf_;
  bool split_digits_;
  std::unordered_map<Key, Ends, KeyHash> memo_;
  std::unordered_map<Key, bool, KeyHash> open_;  ///< rules being computed; true = met again
  std::vector<Key> log_;
  std::size_t steps_ = 0;
  int depth_ = 0;
  bool touched_end_ = false;
  bool over_limit_ = false;
};

}  // namespace vxml::srgs
