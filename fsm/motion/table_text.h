#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

/// One line of a table with something on it.
struct TableLine {
  int number = 0;                  ///< 1-based
  std::vector<std::string> words;  ///< at least one
};

/// A table as text: words between blanks and tabs, a word that starts with `#` begins
/// a comment (there is a phoneme "h#"), blank lines mean nothing.
class TableText {
 public:
  TableText(std::string name, std::string_view text);

  const std::vector<TableLine>& lines() const { return lines_; }
  const std::string& name() const { return name_; }
  /// kBadValue "NAME:LINE: text"; line 0 speaks of the whole table.
  std::unexpected<vm::Error> Wrong(int line, const std::string& text) const;
  /// A finite number in lowest..highest, or an error that says what was found where.
  vm::Result<double> Number(const TableLine& line, std::size_t word, const std::string& what,
                            double lowest, double highest) const;
  /// Nothing if the word is a name (a letter, then letters, digits and _; at most 40), which may
  /// become part of a slot's name; else an error like the above.
  vm::Result<void> Name(const TableLine& line, std::size_t word, const std::string& what) const;

 private:
  std::string name_;
  std::vector<TableLine> lines_;
};

/// The bytes of a table's file. Errors: kUnavailable if it cannot be read or is no plain file,
/// kLimit if it is longer than kMaxTableBytes (a table is something people write).
vm::Result<std::string> ReadTableFile(const std::string& path);
inline constexpr std::size_t kMaxTableBytes = 4 * 1024 * 1024;

/// Nothing, or kBadUtf8 "NAME:LINE: ..." for the first byte that is not UTF-8: what stands in a
/// table is shown again in lists and messages.
vm::Result<void> CheckTableEncoding(const std::string& name, std::string_view text);

/// A finite decimal number that fills the whole word.
vm::Result<double> ParseNumber(std::string_view word);

}  // namespace fsm
