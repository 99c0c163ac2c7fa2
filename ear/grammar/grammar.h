#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace ear {

/// A part of a grammar.
struct Node {
  enum class Kind {
    kWord,      ///< `text`, lower case
    kAny,       ///< any words, one or more
    kSequence,  ///< all `parts` in order; empty = nothing
    kChoice,    ///< one of `parts`, with `weights` beside them (1 = usual)
    kRepeat,    ///< parts[0], `least` to `most` times
    kRule,      ///< the rule named `text`
    kTag,       ///< `text` is a piece of meaning; takes no words
    kVoid       ///< never matches
  };
  Kind kind = Kind::kSequence;
  std::string text{};
  std::vector<Node> parts{};
  std::vector<double> weights{};
  int least = 1;
  int most = 1;          ///< kUnlimited = no limit
  std::size_t line = 0;  ///< where it stands in the source; 0 = not known
};
inline constexpr int kUnlimited = -1;

/// Stands in the words of a heard text for one or more words that were not understood; only "any
/// word" takes it.
inline constexpr std::string_view kNotUnderstood = "...";

class Network;

/// What may be said, as a set of rules. Constant once it is made; copies share it.
/// Limits: those of grammar_limits.h.
class Grammar {
 public:
  using Rules = std::map<std::string, Node, std::less<>>;

  /// Checks the rules: every rule named is there, none begins with itself (left recursion), the
  /// limits are kept. Errors: kBadValue, kLimit, naming the rule and the line.
  static vm::Result<Grammar> Make(Rules rules, std::string root);

  /// What a text means.
  struct Meaning {
    std::vector<std::string> tags;  ///< in order of the words
    std::string Joined() const;     ///< with ';' between
  };
  /// The first way in which the whole text fits; none if it does not. Case, punctuation and blanks
  /// between other than Latin words do not count.
  std::optional<Meaning> Match(std::string_view text) const;
  /// The same for words, each as WordsOf or kNotUnderstood.
  std::optional<Meaning> Match(const std::vector<std::string>& words) const;
  /// Every word there is to be heard.
  std::set<std::string> Words() const;
  /// True if somewhere any word may stand.
  bool HasAny() const { return has_any_; }

  /// How many parts it has when every repeat and every rule in it is written out.
  std::size_t expanded_parts() const { return expanded_parts_; }

  const Rules& rules() const { return *rules_; }
  const std::string& root() const { return root_; }

 private:
  std::shared_ptr<const Rules> rules_;
  std::shared_ptr<const Network> network_;  // borrows from rules_
  std::string root_;
  std::size_t expanded_parts_ = 0;
  bool has_any_ = false;
};

/// The three forms of source; all errors name the line.
///   own   phrases with | between, at most one rule a line with $name = in front (docs/speech.md)
///   JSGF  begins "#JSGF"            SRGS  begins "<"
vm::Result<Grammar> ParseGrammar(std::string_view text);
vm::Result<Grammar> ParseOwnForm(std::string_view text);
vm::Result<Grammar> ParseJsgf(std::string_view text);
vm::Result<Grammar> ParseSrgs(std::string_view text);

/// "rule 'x'"; the phrases outside of all rules are a rule without a name.
std::string RuleLabel(std::string_view rule);

/// Lower-case words of a text: runs of ASCII letters, digits, ' and -, and runs of characters
/// beyond ASCII without punctuation.
std::vector<std::string> WordsOf(std::string_view text);

}  // namespace ear
