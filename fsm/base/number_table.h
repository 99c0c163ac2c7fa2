#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/range.h"
#include "fsm/base/table_reader.h"

namespace fsm {

/// Named numbers that can be edited without compiling. A row is a name (one word or more) and as
/// many numbers as the built-in table of that kind has for it; each name occurs once, and rows that
/// are left out are built in. LOW..HIGH at the end of a built-in row are the limits of its numbers,
/// for rows that replace it, too (whose own limits are ignored); without it they are -1000..1000.
/// A word between the two numbers of a built-in row says what they are: "12 to 24" is a Range,
/// "0.4 up_to 0.9" one whose first number must not exceed the second, "1.8 plus 2.9" a Linear; two
/// numbers without such a word are a place or size, x y. Rows that replace it need not repeat the
/// word, but may not have another one.
/// Code does not look names up: galatea_numbers (cmake/Embed.cmake) turns rows into members of a
/// struct that Get fills. Constant after construction; thread: any.
class NumberTable {
 public:
  NumberTable() = default;  ///< a table without names
  /// Reads a table that overrides rows of `built_in`, or a built-in table itself if that is null.
  /// Throws std::runtime_error naming file and line if a name is repeated or unknown, or if a row
  /// has another count of numbers than the built-in one, a number beyond its limits, another word
  /// between its numbers, or a range that descends where it may not.
  NumberTable(const std::string& file, std::string_view text,
              const NumberTable* built_in = nullptr);

  /// Returns a row's numbers. REQUIRES, here and below: the built-in table has as many for it.
  const std::vector<float>& operator[](std::string_view name) const;
  void Get(std::string_view name, float& out) const { Copy(name, {&out, 1}); }
  template <glm::length_t N>
  void Get(std::string_view name, glm::vec<N, float>& out) const {
    Copy(name, {&out[0], N});
  }
  void Get(std::string_view name, Range& out) const { out = {(*this)[name][0], (*this)[name][1]}; }
  void Get(std::string_view name, Linear& out) const { out = {(*this)[name][0], (*this)[name][1]}; }
  template <std::size_t N>
  void Get(std::string_view name, std::array<float, N>& out) const {
    Copy(name, out);
  }

  /// Returns the rows in the order of the built-in table.
  const std::vector<TableRow>& rows() const { return rows_; }
  static std::string RowName(const TableRow& row);

 private:
  /// Returns the error text for an unknown `name`: it lists the rows whose name begins with `word`.
  std::string NoRow(const std::string& word, const std::string& name) const;
  void Copy(std::string_view name, std::span<float> out) const;

  std::vector<TableRow> rows_;
  std::vector<std::vector<float>> numbers_;                 // by row
  std::vector<std::string> marks_;                          // by row: the word between two numbers
  std::vector<Range> limits_;                               // by row: least and greatest number
  std::map<std::string, std::size_t, std::less<>> places_;  // row index by name
};

/// Returns a row of two to four numbers as a list.
template <glm::length_t N>
std::span<const float> ListOf(const glm::vec<N, float>& row) {
  return {&row[0], N};
}

}  // namespace fsm
