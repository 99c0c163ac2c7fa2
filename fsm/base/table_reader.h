#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace fsm {

/// One line of a table: a key word and what follows it. Blank lines and `#` comments are dropped.
class TableRow {
 public:
  TableRow(std::string table, int line, std::vector<std::string> words)
      : table_(std::move(table)), line_(line), words_(std::move(words)) {}

  const std::string& key() const { return words_.front(); }
  std::size_t size() const { return words_.size(); }
  /// Throws std::runtime_error naming file and line if word `index` is missing or of another kind.
  const std::string& Word(std::size_t index) const;
  float Number(std::size_t index) const;
  /// A number in low..high.
  float Within(std::size_t index, float low, float high) const;
  int Integer(std::size_t index) const;
  glm::vec3 Vector(std::size_t index) const;  ///< words index .. index + 2
  /// All words from `index` on, as numbers.
  std::vector<float> Numbers(std::size_t index) const;
  /// Throws if more than `count` words stand in the row: a word too many stands in a wrong place.
  void EndsAt(std::size_t count) const;
  [[noreturn]] void Fail(const std::string& what) const;

 private:
  std::string table_;
  int line_;
  std::vector<std::string> words_;
};

/// Splits a table into rows. `table` is the name used in messages. What its rows throw,
/// std::runtime_error "tables/x.txt:12: ...", is a failure at start for tables of the program.
class Table {
 public:
  Table(std::string table, std::string_view text);

  const std::vector<TableRow>& rows() const { return rows_; }
  std::vector<TableRow> RowsOf(std::string_view key) const;
  /// The only row with that key; throws if there is none or more than one.
  const TableRow& Only(std::string_view key) const;
  const std::string& name() const { return table_; }

 private:
  std::string table_;
  std::vector<TableRow> rows_;
};

}  // namespace fsm
