#include "face_editor/core/unit_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>

namespace editor {
namespace {

constexpr std::string_view kBlank = " \t\r";

/// What of a line is no comment, as fsm::Table takes it.
std::string_view Said(std::string_view line) {
  std::size_t at = line.find('#');
  while (at != 0 && at != std::string_view::npos && !kBlank.contains(line[at - 1])) {
    at = line.find('#', at + 1);
  }
  return line.substr(0, at);
}

std::vector<std::string> WordsOf(std::string_view line) {
  const fsm::Table table("", line);
  return table.rows().empty() ? std::vector<std::string>() : table.rows()[0].words();
}

std::vector<std::string_view> LinesOf(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

/// The line with other words; what follows a word stays in its column where there is room.
std::string Reworded(std::string_view line, const std::vector<std::string>& words) {
  const std::string_view said = Said(line);
  std::string out;
  std::size_t at = 0;
  for (const std::string& word : words) {
    const std::size_t begin = std::min(said.find_first_not_of(kBlank, at), said.size());
    const std::size_t end = std::min(said.find_first_of(kBlank, begin), said.size());
    const std::string_view old = said.substr(begin, end - begin);
    std::string_view blank = said.substr(at, begin - at);
    // Numbers end where they ended.
    const std::size_t longer = word.size() > old.size() ? word.size() - old.size() : 0;
    const std::size_t shorter = old.size() > word.size() ? old.size() - word.size() : 0;
    const std::size_t least = at == 0 ? 0 : 1;
    const std::size_t room = blank.size() > least ? blank.size() - least : 0;
    blank.remove_suffix(std::min(longer, room));
    out += std::string(blank) + std::string(at == 0 ? 0 : shorter, ' ') + word;
    at = end;
  }
  return out + std::string(line.substr(at));
}

std::string NewLine(const UnitRow& row) {
  std::string line = fmt::format("{:<5}", row.words[0]);
  for (std::size_t i = 1; i < row.words.size(); ++i) line += " " + row.words[i];
  return line;
}

bool Concerns(const UnitRow& row, int unit) {
  return row.words.size() > 1 && row.words[1] == std::to_string(unit);
}

vm::Result<std::shared_ptr<const Units>> Make(const fsm::Table& table, UnitRows rows,
                                              std::shared_ptr<const std::string> text) {
  try {
    return std::make_shared<const Units>(
        Units{std::move(text), std::move(rows), fsm::UnitTable(table)});
  } catch (const std::exception& error) {
    return vm::Fail(vm::Errc::kBadValue, error.what());
  }
}

}  // namespace

const std::vector<UnitRowKind>& UnitRowKinds() {
  static const std::vector<UnitRowKind> kinds = {
      {"field",
       "moves the skin around a place",
       2,
       {{"a", 0, 70},
        {"b", -120, 80},
        {"along", 2, 60},
        {"down", 2, 60},
        {"part", 0, 0},
        {"x", -12, 12},
        {"y", -12, 12},
        {"z", -12, 12}},
       "25 -42 15 15 both 0 1 0"},
      {"lid", "moves the lids' edges", 2, {{"upper", -6, 6}, {"lower", -4, 4}}, "0 1"},
      {"close", "closes the lids", 2, {{"part", 0, 1}}, "0.5"},
      {"jaw", "opens the jaw", 2, {{"degrees", -5, 28}, {"slide", -4, 12}}, "5 0"},
      {"sway", "moves the jaw sideways", 2, {{"x", -10, 10}}, "4"},
      {"seal", "brings the lips together", 2, {{"part", 0, 1}}, "1"},
      {"tongue", "moves the tongue", 2, {{"raise", 0, 1}, {"out", 0, 30}}, "0.5 5"},
      {"crease",
       "creases the skin",
       2,
       {{"forehead", 0, 1},
        {"glabella", 0, 1},
        {"crows_feet", 0, 1},
        {"nasolabial", 0, 1},
        {"nose", 0, 1},
        {"forehead_sides", 0, 1}},
       "0 0 0 0.5 0 0"},
      {"damp", "is weaker beside unit", 3, {{"part", 0, 1}}, "26 0.5"},
      {"oppose", "shares the face with unit", 3, {}, "26"},
      {"strongest", "only the stronger acts, it or unit", 3, {}, "26"}};
  return kinds;
}

const UnitRowKind* KindOf(const UnitRow& row) {
  const auto kind = std::ranges::find_if(UnitRowKinds(), [&](const UnitRowKind& k) {
    return !row.words.empty() && k.word == row.words[0];
  });
  return kind == UnitRowKinds().end() ? nullptr : &*kind;
}

vm::Result<std::shared_ptr<const Units>> ReadUnits(const std::string& name, std::string_view text) {
  UnitRows rows;
  int number = 0;
  for (const std::string_view line : LinesOf(text)) {
    UnitRow row{WordsOf(line), ++number};
    if (!row.words.empty()) rows.push_back(std::move(row));
  }
  return Make(fsm::Table(name, text), std::move(rows), std::make_shared<const std::string>(text));
}

vm::Result<std::shared_ptr<const Units>> WithRows(const Units& before, UnitRows rows) {
  std::string text;
  for (const UnitRow& row : rows) text += fmt::format("{}\n", fmt::join(row.words, " "));
  auto units = Make(fsm::Table("row", text), std::move(rows), before.text);
  if (units) return units;
  // "row:12: what is wrong": nobody knows this text's lines.
  const std::string& told = units.error().text;
  const std::size_t colon = told.find(": ");
  return vm::Fail(vm::Errc::kBadValue, colon == std::string::npos ? told : told.substr(colon + 2));
}

std::vector<std::size_t> RowsOf(const UnitRows& rows, int unit) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (Concerns(rows[i], unit)) found.push_back(i);
  }
  return found;
}

std::string WriteUnits(const Units& units) {
  const UnitRows& rows = units.rows;
  std::vector<std::pair<std::string, const UnitRow*>> out;
  int number = 0;
  for (const std::string_view line : LinesOf(*units.text)) {
    const auto words = WordsOf(line);
    const auto row = std::ranges::find(rows, ++number, &UnitRow::line);
    if (words.empty()) {
      out.emplace_back(line, nullptr);
    } else if (row != rows.end()) {
      out.emplace_back(row->words == words ? std::string(line) : Reworded(line, row->words), &*row);
    }
  }
  for (const UnitRow& row : rows) {
    if (row.line > 0) continue;
    // After the last row of the same kind and unit, else of the unit, else at the end.
    auto place = out.end();
    for (const bool same_kind : {false, true}) {
      for (auto at = out.begin(); at != out.end(); ++at) {
        const bool fits = at->second && at->second->words[1] == row.words[1] &&
                          (!same_kind || at->second->words[0] == row.words[0]);
        if (fits) place = at + 1;
      }
    }
    out.insert(place, {NewLine(row), &row});
  }
  std::string written;
  for (const auto& line : out) written += line.first + "\n";
  return written;
}

}  // namespace editor
