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

/// The text with '?' in place of control characters and of what is not UTF-8.
std::string Printable(std::string text);

/// Why a table is not used: "NAME:LINE: text", or "NAME: text" of the table as a whole. What is
/// quoted from a damaged table is shortened, well-formed UTF-8 and without control characters.
class TableError : public std::runtime_error {
 public:
  TableError(const std::string& place, const std::string& text);
};

/// One line of a table: a key word and what follows it. Its readers throw TableError where a word
/// is missing or of another kind.
class TableRow {
 public:
  TableRow(const std::string& table, int line, std::vector<std::string> words)
      : place_(table + ":" + std::to_string(line)), words_(std::move(words)) {}

  const std::string& key() const { return words_.front(); }
  std::size_t size() const { return words_.size(); }
  const std::vector<std::string>& words() const { return words_; }
  const std::string& Word(std::size_t index) const;
  float Number(std::size_t index) const;
  /// A number in low..high; `what` says in messages what it means.
  double Number(std::size_t index, std::string_view what, double low, double high) const;
  /// A number in low..high.
  float Within(std::size_t index, float low, float high) const;
  int Integer(std::size_t index) const;
  glm::vec3 Vector(std::size_t index) const;  ///< words index .. index + 2
  /// All words from `index` on, as numbers.
  std::vector<float> Numbers(std::size_t index) const;
  /// A name, which may become part of a slot's name: a letter, then letters, digits and _, at most
  /// 40. REQUIRES: the word is there.
  const std::string& Name(std::size_t index, std::string_view what) const;
  /// Throws if more than `count` words stand in the row: a word too many stands in a wrong place.
  void EndsAt(std::size_t count) const;
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  std::string place_;
  std::vector<std::string> words_;
};

/// Splits a table into rows: words between blanks. A word that begins with `#` begins a comment
/// (within a word `#` is a letter, as in the phoneme "h#"); blank lines mean nothing. `name` is
/// the name used in messages. Thread: any, as it is constant after construction.
class Table {
 public:
  Table(std::string name, std::string_view text);

  const std::vector<TableRow>& rows() const { return rows_; }
  std::vector<TableRow> RowsOf(std::string_view key) const;
  /// The only row with that key; throws TableError if there is none or more than one.
  const TableRow& Only(std::string_view key) const;
  const std::string& name() const { return name_; }
  /// Throws a TableError of the whole table.
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  std::string name_;
  std::vector<TableRow> rows_;
};

/// What `read(table)` returns, or kBadValue with the text of the TableError that it throws.
template <typename Read>
auto ReadTable(const std::string& name, std::string_view text, const Read& read)
    -> vm::Result<std::invoke_result_t<Read, const Table&>> {
  try {
    return read(Table(name, text));
  } catch (const TableError& error) {
    return vm::Fail(vm::Errc::kBadValue, error.what());
  }
}

/// The text of a table's file. Errors: those of vm::ReadTextFile, kTooLong over kMaxTableBytes (a
/// table is something people write), and kBadUtf8 "PATH:LINE: ..." for the first byte that is not
/// UTF-8: what stands in a table is shown again in lists and messages.
vm::Result<std::string> ReadTableFile(const std::string& path);
inline constexpr std::size_t kMaxTableBytes = 4 * 1024 * 1024;

}  // namespace fsm
