#include "fsm/base/table_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fsm/base/parse_number.h"
#include "fsm/base/words.h"
#include "vm_protocol/core/text_file.h"
#include "vm_protocol/core/utf8.h"

namespace fsm {
namespace {

std::string Shown(const std::string& text) {
  constexpr std::size_t kShown = 400;
  std::string shown = text.size() <= kShown ? text
                                            : text.substr(0, kShown / 2) + "..." +
                                                  text.substr(text.size() - kShown / 2);
  return Printable(std::move(shown));  // shortening may have cut a character of several bytes
}

bool IsLetter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

}  // namespace

std::string Printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  while (const auto bad = vm::FirstBadUtf8(text)) text[*bad] = '?';
  return text;
}

bool IsPlainName(std::string_view name) {
  return !name.empty() && name.size() <= kMaxNameBytes && std::ranges::all_of(name, [](char c) {
    return IsLetter(c) || (c >= '0' && c <= '9') || c == '_';
  });
}

TableError::TableError(const std::string& place, const std::string& text)
    : std::runtime_error(place + ": " + Shown(text)) {}

void TableRow::Refuse(const std::string& what) const { throw TableError(place_, what); }

const std::string& TableRow::Word(std::size_t index) const {
  if (index >= words_.size()) {
    Refuse(fmt::format("'{}' needs at least {} values after it, found {}", key(), index,
                       words_.size() - 1));
  }
  return words_[index];
}

float TableRow::Number(std::size_t index) const {
  const std::string& word = Word(index);
  const auto value = ParseNumber<float>(word);
  if (!value) Refuse("'" + word + "' found where a number was expected");
  return *value;
}

template <typename T>
T TableRow::Within(std::size_t index, std::type_identity_t<T> min, std::type_identity_t<T> max,
                   std::string_view what) const {
  if (what.empty()) {
    Number(index);  // its errors need no name
  } else if (index >= words_.size()) {
    Refuse(fmt::format("the line ends where {} is expected", what));
  }
  const auto number = ParseNumber<T>(words_[index]);
  if (number && *number >= min && *number <= max) return *number;
  Refuse(what.empty()
             ? fmt::format("'{}' found where {:g} to {:g} was expected", words_[index], min, max)
             : fmt::format("'{}' found, {} expected, a number from {:g} to {:g}", words_[index],
                           what, min, max));
}
template float TableRow::Within<float>(std::size_t, float, float, std::string_view) const;
template double TableRow::Within<double>(std::size_t, double, double, std::string_view) const;

int TableRow::Integer(std::size_t index) const {
  const float value = Number(index);
  constexpr float kMaxWhole = 1 << 24;  // up to here a float represents every whole number
  if (value != std::floor(value) || std::abs(value) > kMaxWhole) {
    Refuse("'" + Word(index) + "' found where a whole number was expected");
  }
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

const std::string& TableRow::Name(std::size_t index, std::string_view what) const {
  const std::string& name = Word(index);
  if (!IsPlainName(name) || !IsLetter(name[0])) {
    Refuse(fmt::format("'{}' found, {} expected: a letter, then letters, digits and _, at most {}",
                       name.substr(0, kMaxNameBytes), what, kMaxNameBytes));
  }
  return name;
}

void TableRow::EndsAt(std::size_t count) const {
  if (size() > count) Refuse("'" + Word(count) + "' is one word too many");
}

Table::Table(std::string name, std::string_view text) : name_(std::move(name)) {
  for (int line = 1; !text.empty(); ++line) {
    const auto words = WordsOf(ReadUntil("\n", text));
    const auto comment =
        std::ranges::find_if(words, [](std::string_view word) { return word[0] == '#'; });
    if (comment == words.begin()) continue;
    rows_.emplace_back(name_, line, std::vector<std::string>(words.begin(), comment));
  }
}

std::vector<TableRow> Table::RowsOf(std::string_view key) const {
  std::vector<TableRow> found;
  std::ranges::copy_if(rows_, std::back_inserter(found),
                       [&](const TableRow& row) { return row.key() == key; });
  return found;
}

const TableRow& Table::Only(std::string_view key) const {
  const TableRow* found = nullptr;
  for (const TableRow& row : rows_) {
    if (row.key() != key) continue;
    if (found) row.Refuse("'" + std::string(key) + "' given a second time");
    found = &row;
  }
  if (!found) Refuse("no line '" + std::string(key) + "'");
  return *found;
}

void Table::Refuse(const std::string& what) const { throw TableError(name_, what); }

vm::Result<std::string> ReadTableFile(const std::string& path) {
  auto text = vm::ReadTextFile(path, kMaxTableBytes);
  if (!text) return text;
  if (const auto bad = vm::FirstBadUtf8(*text)) {
    const auto line =
        1 + std::count(text->begin(), text->begin() + static_cast<std::ptrdiff_t>(*bad), '\n');
    return vm::Fail(
        vm::Errc::kBadUtf8,
        fmt::format("{}:{}: a byte that is not UTF-8 found, text expected", path, line));
  }
  return text;
}

}  // namespace fsm
