#pragma once

#include <ctime>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace chat {

/// Answers without a model: patterns of what is heard and what is said to it, in the manner of
/// ELIZA (Weizenbaum 1966), from a table such as tables/rules_en.txt, whose head explains its form.
/// Remembers what was said to it (names) and which answer it gave last.
/// Thread: none of its own. Limits: kMaxTokens of what is heard, the rest is not looked at.
class Rules {
 public:
  static constexpr std::size_t kMaxTokens = 120;

  /// Errors: kSyntax or kBadValue with FILE:LINE.
  static vm::Result<Rules> Parse(const std::string& file, std::string_view text);
  const std::string& language() const { return language_; }
  /// With the tags it is written with. Empty if no rule fits. `agent` is $agent, `now` the wall
  /// clock.
  std::string Answer(std::string_view heard, const std::string& agent, const std::tm& now);
  /// Forgets what was said to it.
  void Forget();

 private:
  /// What one place of a pattern takes: any number of words, or one of these.
  struct Element {
    bool any = false;
    std::vector<std::string> words;
  };
  struct Pattern {
    std::vector<Element> elements;
    bool from_start = false, to_end = false;
  };
  struct Rule {
    std::vector<Pattern> patterns;
    std::vector<std::string> answers;
    std::vector<std::pair<std::string, std::string>> keeps;  ///< variable, its new value
    std::size_t next = 0;                                    ///< which answer comes next
  };
  struct Token {
    std::string word;     ///< small letters, as patterns have it
    std::string written;  ///< as it was heard
  };
  using Tokens = std::vector<Token>;
  using Captures = std::vector<std::string>;
  using Variables = std::map<std::string, std::string>;

  vm::Result<void> AddLine(std::string_view line);
  Pattern PatternOf(std::string_view text) const;
  std::vector<Tokens> Clauses(std::string_view heard) const;
  std::optional<Captures> Match(const Pattern& pattern, const Tokens& tokens) const;
  bool MatchFrom(const Pattern& pattern, std::size_t element, const Tokens& tokens, std::size_t at,
                 std::vector<std::pair<std::size_t, std::size_t>>& ranges) const;
  std::string Reflected(const Tokens& tokens, std::size_t begin, std::size_t end) const;
  static std::optional<std::string> Filled(const std::string& answer, const Variables& variables);
  std::string AnswerOf(Rule& rule, Variables variables);

  std::string language_ = "en";
  bool spaced_ = true;  ///< words stand between blanks
  std::map<std::string, std::string> reflections_;
  std::vector<Rule> rules_;
  Variables kept_;
};

}  // namespace chat
