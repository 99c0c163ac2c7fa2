#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace vm {

// clang-format off
/// What a slot accepts, written beside the slot and shown by `inq Slot.help` and docs/reference/slots.md:
///
///     NOW | STOP               words, matched without regard to case
///     <number> <number 0..200> decimal number, optionally bounded (either end may be left out)
///     <int 1..5>               whole number
///     <ms>                     number of milliseconds, 0..86400000
///     <time>                   a start time (vm_protocol/core/start_time.h)
///     <word>                   one word, or a "quoted string" with JSON escapes
///     <text>                   the rest of the line, may be empty
///     <markup>                 as <text>; each src="..." within it names a file
///     <file>                   the rest of the line, or one "quoted string"; not empty
///     A B  [ A ]  ( A | B )  A...    sequence, optional, group, one or more
///
/// NaN, infinities and numbers beyond 1e12 are refused. Matching takes the first alternative that
/// fits the whole value (backtracking; its steps and depth are bounded).
// clang-format on
class ValueGrammar {
 public:
  /// What one value turned out to be: its words in order, as written in the grammar for literal
  /// words, unquoted for strings.
  struct Item {
    std::string text;
    double number = 0;                 ///< for <number>, <int>, <ms>
    std::vector<std::string> files{};  ///< those it names: <file> itself, each src of <markup>
    bool operator==(const Item&) const = default;
  };
  using Items = std::vector<Item>;

  static constexpr std::size_t kMaxBytes = 4096;
  static constexpr std::size_t kMaxDepth = 32;  ///< brackets in each other
  /// A grammar from outside. Errors: kBadValue with the column, what was found, what was expected.
  static Result<ValueGrammar> Parse(std::string_view text);
  /// A grammar that is part of the program. Throws std::logic_error if it is not well-formed.
  explicit ValueGrammar(std::string_view text);
  ~ValueGrammar();
  ValueGrammar(ValueGrammar&&) noexcept;
  ValueGrammar& operator=(ValueGrammar&&) noexcept;

  /// Errors: kBadValue with the column within `value`, what was found, and the grammar expected;
  /// kLimit where the grammar leaves so much open that finding out would take too long.
  Result<Items> Match(std::string_view value) const;
  const std::string& text() const { return text_; }
  /// True if part of a value can name a file, or is a text in which every blank counts.
  bool has_file() const;
  bool has_text() const;
  /// The literal words of it.
  std::vector<std::string> Words() const;

 private:
  struct Node;
  ValueGrammar(std::string_view text, std::unique_ptr<Node> root);
  std::string text_;
  std::unique_ptr<Node> root_;
};

}  // namespace vm
