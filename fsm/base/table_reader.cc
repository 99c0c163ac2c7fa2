#include "fsm/base/table_reader.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace fsm {

void TableRow::Fail(const std::string& what) const {
  throw std::runtime_error(table_ + ":" + std::to_string(line_) + ": " + what);
}

const std::string& TableRow::Word(std::size_t index) const {
  if (index >= words_.size()) {
    Fail("'" + key() + "' needs at least " + std::to_string(index) + " values after it, found " +
         std::to_string(words_.size() - 1));
  }
  return words_[index];
}

float TableRow::Number(std::size_t index) const {
  const std::string& word = Word(index);
  float value = 0;
  const char* begin = word.data() + (word.front() == '+' ? 1 : 0);
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) {
    Fail("'" + word + "' found where a number was expected");
  }
  return value;
}

float TableRow::Within(std::size_t index, float low, float high) const {
  const float value = Number(index);
  if (!(value >= low && value <= high)) {
    std::array<char, 48> bounds;
    std::snprintf(bounds.data(), bounds.size(), "%g to %g", static_cast<double>(low),
                  static_cast<double>(high));
    Fail("'" + Word(index) + "' found where " + bounds.data() + " was expected");
  }
  return value;
}

void TableRow::EndsAt(std::size_t count) const {
  if (size() > count) Fail("'" + Word(count) + "' is one word too many");
}

int TableRow::Integer(std::size_t index) const {
  const float value = Number(index);
  if (value != std::floor(value))
    Fail("'" + Word(index) + "' found where a whole number was expected");
  return static_cast<int>(value);
}

glm::vec3 TableRow::Vector(std::size_t index) const {
  return {Number(index), Number(index + 1), Number(index + 2)};
}

std::vector<float> TableRow::Numbers(std::size_t index) const {
  std::vector<float> values;
  for (std::size_t i = index; i < size(); ++i) values.push_back(Number(i));
  return values;
}

Table::Table(std::string table, std::string_view text) : table_(std::move(table)) {
  int line_number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++line_number;
    line = line.substr(0, line.find('#'));
    std::vector<std::string> words;
    constexpr std::string_view kBlank = " \t\r";
    for (std::size_t at = line.find_first_not_of(kBlank); at != std::string_view::npos;) {
      const std::size_t stop = line.find_first_of(kBlank, at);
      words.emplace_back(line.substr(at, stop - at));
      at = line.find_first_not_of(kBlank, stop);
    }
    if (!words.empty()) rows_.emplace_back(table_, line_number, std::move(words));
  }
}

std::vector<TableRow> Table::RowsOf(std::string_view key) const {
  std::vector<TableRow> found;
  for (const TableRow& row : rows_) {
    if (row.key() == key) found.push_back(row);
  }
  return found;
}

const TableRow& Table::Only(std::string_view key) const {
  const TableRow* found = nullptr;
  for (const TableRow& row : rows_) {
    if (row.key() != key) continue;
    if (found) row.Fail("'" + std::string(key) + "' given a second time");
    found = &row;
  }
  if (!found) throw std::runtime_error(table_ + ": no line '" + std::string(key) + "'");
  return *found;
}

}  // namespace fsm
