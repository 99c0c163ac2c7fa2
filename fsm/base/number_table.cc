#include "fsm/base/number_table.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <set>

#include "fsm/base/parse_number.h"

namespace fsm {
namespace {

constexpr std::string_view kTo = "..";  // between the limits of a row
constexpr Range kUsualLimits{-1000, 1000};
constexpr std::string_view kAscends = "up_to";
constexpr std::string_view kMarks[] = {"to", kAscends, "plus"};  // between the numbers of a row

/// Returns the number of leading words that cannot be read as a number.
std::size_t NameWordsOf(const TableRow& row) {
  constexpr std::string_view kNumberBegins = "+-.0123456789";
  std::size_t words = 1;
  while (words < row.size() && kNumberBegins.find(row.Word(words)[0]) == std::string_view::npos)
    ++words;
  return words;
}

bool HasLimits(const TableRow& row) { return row.words().back().contains(kTo); }

Range LimitsOf(const TableRow& row) {
  const std::string_view word = row.words().back();
  const std::size_t to = word.find(kTo);
  const auto min = ParseNumber<float>(word.substr(0, to));
  const auto max = ParseNumber<float>(word.substr(to + kTo.size()));
  if (!min || !max) row.Refuse("limits LOW..HIGH expected");
  return {*min, *max};
}

/// The words of a row after its name.
struct RowParts {
  std::vector<std::size_t> numbers;  ///< their places in the row
  std::string mark;                  ///< the word between two of them; "": none
};

RowParts PartsOf(const TableRow& row) {
  const std::size_t first = NameWordsOf(row);
  const std::size_t end = row.size() - (HasLimits(row) ? 1 : 0);
  if (end == first + 3 && std::ranges::find(kMarks, row.Word(first + 1)) != std::end(kMarks))
    return {{first, first + 2}, row.Word(first + 1)};
  RowParts parts;
  for (std::size_t i = first; i < end; ++i) parts.numbers.push_back(i);
  return parts;
}

}  // namespace

std::string NumberTable::RowName(const TableRow& row) {
  std::string name = row.key();
  for (std::size_t i = 1; i < NameWordsOf(row); ++i) name += " " + row.Word(i);
  return name;
}

NumberTable::NumberTable(const std::string& file, std::string_view text,
                         const NumberTable* built_in) {
  if (built_in != nullptr) *this = *built_in;
  std::set<std::string> given;
  const Table table(file, text);
  for (const TableRow& row : table.rows()) {
    const std::string name = RowName(row);
    if (!given.insert(name).second) row.Refuse("'" + name + "' is there twice");
    const RowParts parts = PartsOf(row);
    const std::size_t count = parts.numbers.size();
    for (const std::size_t i : parts.numbers)
      row.Number(i);  // its error precedes that of the count
    auto known = places_.find(name);
    if (built_in == nullptr) {
      known = places_.emplace(name, rows_.size()).first;
      rows_.push_back(row);
      numbers_.emplace_back(count);
      marks_.push_back(parts.mark);
      limits_.push_back(HasLimits(row) ? LimitsOf(row) : kUsualLimits);
    } else if (known == places_.end()) {
      row.Refuse(built_in->NoRow(row.key(), name));
    }
    std::vector<float>& own = numbers_[known->second];
    if (count != own.size()) {
      row.Refuse("'" + name + "' needs " + std::to_string(own.size()) +
                 " numbers after it, found " + std::to_string(count));
    }
    const std::string& mark = marks_[known->second];
    if (!parts.mark.empty() && parts.mark != mark) {
      row.Refuse("'" + parts.mark + "' found where " +
                 (mark.empty() ? "a number" : "'" + mark + "'") + " was expected");
    }
    const Range limits = limits_[known->second];
    for (std::size_t k = 0; k < count; ++k)
      own[k] = row.Within(parts.numbers[k], limits.from, limits.to);
    if (mark == kAscends && own[0] > own[1])
      row.Refuse("the first number of '" + name + "' exceeds the second");
    rows_[known->second] = row;
  }
}

std::string NumberTable::NoRow(const std::string& word, const std::string& name) const {
  std::string others;
  for (const auto& [other, unused] : places_) {
    if (other.starts_with(word + " ")) others += (others.empty() ? "" : ", ") + other;
  }
  return "'" + name + "' is not known" + (others.empty() ? "" : "; known are " + others);
}

const std::vector<float>& NumberTable::operator[](std::string_view name) const {
  const auto found = places_.find(name);
  assert(found != places_.end());
  return numbers_[found->second];
}

void NumberTable::Copy(std::string_view name, std::span<float> out) const {
  const std::vector<float>& numbers = (*this)[name];
  assert(numbers.size() == out.size());
  std::ranges::copy(numbers, out.begin());
}

}  // namespace fsm
