#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/smooth_step.h"
#include "fsm/base/table_reader.h"

namespace fsm {

/// Numbers by name, to be edited without compiling: rows of a name, which is one word or more, and
/// as many numbers as the built-in table of that kind has there, each name once; rows left out are
/// the built-in ones. Code does not ask by name: galatea_numbers (cmake/Embed.cmake) makes the rows
/// of a table members of a struct that Get fills. Constant after construction; thread: any.
class NumberTable {
 public:
  NumberTable() = default;  ///< of no names
  /// In place of `built_in`; a built-in table itself without it. Throws std::runtime_error naming
  /// file and line where a name is there twice or unknown, or has another count of numbers or
  /// numbers beyond -1000..1000.
  NumberTable(const std::string& file, std::string_view text,
              const NumberTable* built_in = nullptr);

  /// The numbers behind a name. REQUIRES, here and below: the built-in table has it, and as many.
  const std::vector<float>& operator[](std::string_view name) const;
  void Get(std::string_view name, float& out) const { Copy(name, {&out, 1}); }
  template <glm::length_t N>
  void Get(std::string_view name, glm::vec<N, float>& out) const {
    Copy(name, {&out[0], N});
  }
  template <std::size_t N>
  void Get(std::string_view name, std::array<float, N>& out) const {
    Copy(name, out);
  }

  /// In the order of the built-in table.
  const std::vector<TableRow>& rows() const { return rows_; }
  static std::string NameOf(const TableRow& row);

 private:
  /// That `name` is not known, and which names begin with `word`, each of a row of its own.
  std::string NoRow(const std::string& word, const std::string& name) const;
  void Copy(std::string_view name, std::span<float> out) const;

  std::vector<TableRow> rows_;
  std::vector<std::vector<float>> numbers_;                 // of each row
  std::map<std::string, std::size_t, std::less<>> places_;  // of a name among the rows
};

/// Of a row of two to four numbers that is a list.
template <glm::length_t N>
std::span<const float> ListOf(const glm::vec<N, float>& row) {
  return {&row[0], N};
}

// Rows that are ranges, or a number and another.
/// `part` of the way from the first to the second.
inline float Between(glm::vec2 row, float part) { return glm::mix(row.x, row.y, part); }
/// The first, and the second times `x`.
inline float Linear(glm::vec2 row, float x) { return row.x + row.y * x; }
/// SmoothStep from the first to the second.
inline float SmoothStep(glm::vec2 row, float x) { return SmoothStep(row.x, row.y, x); }

}  // namespace fsm
