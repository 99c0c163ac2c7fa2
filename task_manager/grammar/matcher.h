#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "task_manager/grammar/model.h"

namespace vxml::srgs {

struct Parse;

/// What a rule matched, in order: tokens, tags and the rules referred to.
struct ParseItem {
  enum class Kind { kToken, kTag, kRule, kGarbage };
  Kind kind = Kind::kToken;
  std::string text;  ///< token or tag as written, or the words GARBAGE took
  std::unique_ptr<Parse> rule;
};

/// The logical parse of one rule (SRGS 1.0 appendix H).
struct Parse {
  const Rule* rule = nullptr;
  std::string name;       ///< the rule's name as referred to
  std::size_t begin = 0;  ///< bytes of the folded input
  std::size_t end = 0;
  std::vector<ParseItem> items;

  /// The words matched, as the grammar writes them.
  std::string Text() const;
  /// $rule["token", {tag}, $other["token"]]
  std::string Format() const;
};

struct MatchResult {
  std::unique_ptr<Parse> parse;  ///< null = no match of the whole input
  bool can_continue = false;     ///< a longer input that begins with this one may match
  bool over_limit = false;       ///< given up: the grammar is too ambiguous or recursive
};

/// Matches whole inputs against a linked grammar, in time cubic in the input whatever the grammar.
/// Recursion of any kind is allowed. Of several parses the one is returned that takes alternatives
/// by weight, then in document order, the most turns of repeats, and lets each part take as much as
/// the rest allows; in a cyclic grammar, of those parses that end.
/// Limits: kMaxInputBytes of input; kMaxSteps machine words of sets of places looked at;
/// kMaxParseDepth expansions inside each other in a parse.
inline constexpr std::size_t kMaxInputBytes = 4096;
inline constexpr std::size_t kMaxSteps = 60'000'000;
inline constexpr int kMaxParseDepth = 4000;
MatchResult Match(const Rule& root, const std::string& input);

}  // namespace vxml::srgs
