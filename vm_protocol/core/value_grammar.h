#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vm {

/// What a slot accepts, written beside the slot and shown by `inq Slot.help` and docs/slots.md:
///
///     NOW | STOP                        words, matched without regard to case
///     <number>  <number 0..200>         decimal number, optionally bounded (either end may be left
///     out) <int 1..5>                        whole number <ms>                              number
///     of milliseconds, 0..86400000 <time>                            a start time
///     (vm_protocol/core/start_time.h) <word>                            one word, or a "quoted
///     string" with JSON escapes <text>                            the rest of the line, may be
///     empty <file>                            the rest of the line, or one "quoted string"; not
///     empty A B   [ A ]   ( A | B )   A...    sequence, optional, group, one or more
///
/// NaN, infinities and numbers beyond 1e12 are refused. Matching takes the first alternative that
/// fits the whole value (backtracking; value size is bounded by the line limit).
class ValueGrammar {
 public:
  /// What one value turned out to be: its words in order, as written in the grammar for literal
  /// words, unquoted for strings.
  struct Item {
    std::string text;
    double number = 0;  ///< for <number>, <int>, <ms>
    bool operator==(const Item&) const = default;
  };
  using Items = std::vector<Item>;

  /// REQUIRES: `text` is a well-formed grammar (asserted: grammars are part of the program).
  explicit ValueGrammar(std::string_view text);
  ~ValueGrammar();
  ValueGrammar(ValueGrammar&&) noexcept;
  ValueGrammar& operator=(ValueGrammar&&) noexcept;

  /// Errors: kBadValue with the column within `value`, what was found, and the grammar expected.
  Result<Items> Match(std::string_view value) const;
  const std::string& text() const { return text_; }

 private:
  struct Node;
  std::string text_;
  std::unique_ptr<Node> root_;
};

}  // namespace vm
