#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace srm_stub {

/// What is compared: words in lower case without punctuation; every character beyond ASCII is a
/// word of its own, since Japanese is written without blanks.
std::vector<std::string> WordsOf(std::string_view text);

/// A list of phrases to be recognised.
///     PHRASE | PHRASE ...        each may end in {meaning}
///     word  *  [optional words]  (one | other | third)
/// `*` is any one word. For example: yes [please] {YES} | (no | nope) {NO} | call *
/// Limits: kMaxBytes, kMaxDepth; matching takes time in proportion to grammar times input.
class WordGrammar {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{16} * 1024;
  static constexpr int kMaxDepth = 32;

  /// Errors: kSyntax with the column, kTooLong, kLimit (nesting).
  static vm::Result<WordGrammar> Parse(std::string_view text);
  ~WordGrammar();
  WordGrammar(WordGrammar&&) noexcept;
  WordGrammar& operator=(WordGrammar&&) noexcept;

  /// The meaning of the first phrase that fits all the words ("" if it has none); none if none
  /// fits.
  std::optional<std::string> Match(const std::vector<std::string>& words) const;
  const std::string& text() const { return text_; }

 private:
  struct Node;
  struct Phrase;
  class Parser;
  WordGrammar();
  std::string text_;
  std::vector<Phrase> phrases_;
};

}  // namespace srm_stub
