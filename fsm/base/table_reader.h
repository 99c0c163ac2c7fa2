#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "vm_protocol/core/result.h"

namespace fsm {

/// Returns the text with '?' for control characters and for bytes that are not valid UTF-8.
std::string Printable(std::string text);

/// Why a table was rejected: "NAME:LINE: text", or "NAME: text" for the whole table. Text quoted
/// from a damaged table is shortened, valid UTF-8 and without control characters.
class TableError : public std::runtime_error {
 public:
  TableError(const std::string& place, const std::string& text);
};

/// Tells whether a name may become part of a slot's name: letters, digits and _, 1 to
/// kMaxNameBytes of them.
bool IsPlainName(std::string_view name);
inline constexpr std::size_t kMaxNameBytes = 40;

/// One row of a table: a key word and the words after it. The functions that read a word throw
/// TableError if it is missing or of the wrong kind.
class TableRow {
 public:
  TableRow(const std::string& table, int line, std::vector<std::string> words)
      : place_(table + ":" + std::to_string(line)), words_(std::move(words)) {}

  const std::string& key() const { return words_.front(); }
  std::size_t size() const { return words_.size(); }
  const std::vector<std::string>& words() const { return words_; }
  const std::string& Word(std::size_t index) const;
  float Number(std::size_t index) const;
  /// Returns a number (float or double) in min..max; `what` names it in error messages.
  template <typename T = float>
  T Within(std::size_t index, std::type_identity_t<T> min, std::type_identity_t<T> max,
           std::string_view what = {}) const;
  int Integer(std::size_t index) const;
  glm::vec3 Vector(std::size_t index) const;  ///< from words index .. index + 2
  /// Returns all words from `index` on as numbers.
  std::vector<float> Numbers(std::size_t index) const;
  /// Returns a plain name that begins with a letter. REQUIRES: the word exists.
  const std::string& Name(std::size_t index, std::string_view what) const;
  /// Throws if the row has more than `count` words, since an extra word was put in the wrong place.
  void EndsAt(std::size_t count) const;
  [[noreturn]] void Refuse(const std::string& what) const;

 private:
  std::string place_;
  std::vector<std::string> words_;
};

/// A text table split into rows of words separated by blanks. A word that begins with `#` starts a
/// comment (inside a word `#` is an ordinary character, as in the phoneme "h#"); blank lines are
/// skipped. `name` appears in error messages. Constant after construction; thread: any.
class Table {
 public:
  Table(std::string name, std::string_view text);

  const std::vector<TableRow>& rows() const { return rows_; }
  std::vector<TableRow> RowsOf(std::string_view key) const;
  /// Returns the only row with that key. Throws TableError if there is none or more than one.
  const TableRow& Only(std::string_view key) const;
  const std::string& name() const { return name_; }
  /// Throws a TableError that concerns the whole table.
  [[noreturn]] void Refuse(const std::string& what) const;

 private:
  std::string name_;
  std::vector<TableRow> rows_;
};

/// Returns what `read(table)` returns, or kBadValue with the text of its TableError.
template <typename Read>
auto ReadTable(const std::string& name, std::string_view text, const Read& read)
    -> vm::Result<std::invoke_result_t<Read, const Table&>> {
  try {
    return read(Table(name, text));
  } catch (const TableError& error) {
    return vm::Fail(vm::Errc::kBadValue, error.what());
  }
}

/// Reads a table's file. Errors: those of vm::ReadTextFile; kTooLong above kMaxTableBytes (tables
/// are written by people); kBadUtf8 "PATH:LINE: ..." for the first byte that is not UTF-8, because
/// words of a table appear in lists and messages.
vm::Result<std::string> ReadTableFile(const std::string& path);
inline constexpr std::size_t kMaxTableBytes = 4 * 1024 * 1024;

}  // namespace fsm
