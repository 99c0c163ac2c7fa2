#include "fsm/base/number_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <set>
#include <utility>

namespace fsm {
namespace {

constexpr float kMost = 1000;

/// Returns the number of leading words that cannot be read as a number.
std::size_t NameWordsOf(const TableRow& row) {
  constexpr std::string_view kNumberBegins = "+-.0123456789";
  std::size_t words = 1;
  while (words < row.size() && kNumberBegins.find(row.Word(words)[0]) == std::string_view::npos)
    ++words;
  return words;
}

}  // namespace

std::string NumberTable::NameOf(const TableRow& row) {
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
    const std::string name = NameOf(row);
    std::vector<float> numbers = row.Numbers(NameWordsOf(row));
    for (const float number : numbers) {
      if (std::abs(number) > kMost) row.Fail("a number beyond -1000 to 1000");
    }
    if (!given.insert(name).second) row.Fail("'" + name + "' is there twice");
    if (built_in == nullptr) {
      places_[name] = rows_.size();
      rows_.push_back(row);
      numbers_.push_back(std::move(numbers));
      continue;
    }
    const auto known = places_.find(name);
    if (known == places_.end()) row.Fail(built_in->NoRow(row.key(), name));
    std::vector<float>& own = numbers_[known->second];
    if (numbers.size() != own.size()) {
      row.Fail("'" + name + "' needs " + std::to_string(own.size()) + " numbers after it, found " +
               std::to_string(numbers.size()));
    }
    rows_[known->second] = row;
    own = std::move(numbers);
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
