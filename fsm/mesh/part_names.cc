#include "fsm/mesh/part_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "embedded/part_names.h"

namespace fsm {
namespace {

/// In the order of PartKind.
constexpr std::array<std::string_view, 9> kKindNames{"skin",  "eye",  "teeth", "gum",  "tongue",
                                                     "mouth", "hair", "lash",  "other"};

constexpr bool IsCapital(char c) { return c >= 'A' && c <= 'Z'; }
constexpr bool IsSmall(char c) { return c >= 'a' && c <= 'z'; }

/// Splits a name into words, in lower case.
std::vector<std::string> WordsOfName(std::string_view name) {
  std::vector<std::string> words;
  char before = ' ';
  for (const char c : name) {
    const bool letter = IsSmall(c) || IsCapital(c);
    const bool begins =
        !(IsSmall(before) || IsCapital(before)) || (IsSmall(before) && IsCapital(c));
    if (letter && begins) words.emplace_back();
    if (letter) words.back() += IsCapital(c) ? static_cast<char>(c - 'A' + 'a') : c;
    before = c;
  }
  return words;
}

/// `pattern`: * at an end matches any text.
bool Fits(std::string_view pattern, std::string_view word) {
  const bool open_begin = pattern.starts_with('*'), open_end = pattern.ends_with('*');
  if (open_begin) pattern.remove_prefix(1);
  if (open_end) pattern.remove_suffix(1);
  if (open_begin && open_end) return word.find(pattern) != std::string_view::npos;
  return open_begin ? word.ends_with(pattern)
         : open_end ? word.starts_with(pattern)
                    : word == pattern;
}

}  // namespace

PartNames::PartNames(const Table& table) {
  for (const TableRow& row : table.rows()) {
    const auto found = std::ranges::find(kKindNames, row.key());
    if (found == kKindNames.end() || row.size() < 2) {
      row.Refuse(fmt::format("KIND WORD... expected, KIND one of {}", fmt::join(kKindNames, ", ")));
    }
    rows_.push_back({static_cast<PartKind>(found - kKindNames.begin()),
                     {row.words().begin() + 1, row.words().end()}});
  }
}

const PartNames& PartNames::BuiltIn() {
  static const PartNames table(Table("tables/part_names.txt", embedded::part_names()));
  return table;
}

PartKind PartNames::KindOf(std::string_view name) const {
  const std::vector<std::string> words = WordsOfName(name);
  const auto has = [&words](const std::string& pattern) {
    return std::ranges::any_of(words, [&](const auto& word) { return Fits(pattern, word); });
  };
  const auto found = std::ranges::find_if(
      rows_, [&](const Row& row) { return std::ranges::all_of(row.words, has); });
  return found == rows_.end() ? PartKind::kSkin : found->kind;
}

}  // namespace fsm
