#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/base/table_reader.h"

namespace fsm {

/// Numbers by name, to be edited without compiling: rows of a name, which is one word or more, and
/// as many numbers as the built-in table of that kind has there, each name once; rows left out are
/// the built-in ones. Constant after construction; thread: any.
class NumberTable {
 public:
  NumberTable() = default;  ///< of no names
  /// In place of `built_in`; a built-in table itself without it. Throws std::runtime_error naming
  /// file and line where a name is there twice or unknown, or has another count of numbers or
  /// numbers beyond -1000..1000.
  NumberTable(const std::string& file, std::string_view text,
              const NumberTable* built_in = nullptr);

  /// All numbers behind a name. REQUIRES of all below: the built-in table has it,
  /// and as many numbers.
  const std::vector<float>& operator[](std::string_view name) const;
  /// The only one.
  float operator()(std::string_view name) const { return (*this)[name].at(0); }
  /// The first two, three and four.
  glm::vec2 Pair(std::string_view name) const;
  glm::vec3 Vector(std::string_view name) const;
  glm::vec4 Vector4(std::string_view name) const;
  /// The first, and the second times `x`.
  float Linear(std::string_view name, float x) const;

  /// In the order of the built-in table.
  const std::vector<TableRow>& rows() const { return rows_; }
  static std::string NameOf(const TableRow& row);

 private:
  /// That `name` is not known, and which names begin with `word`, each of a row of its own.
  std::string NoRow(const std::string& word, const std::string& name) const;

  std::vector<TableRow> rows_;
  std::vector<std::vector<float>> numbers_;                 // of each row
  std::map<std::string, std::size_t, std::less<>> places_;  // of a name among the rows
};

}  // namespace fsm
