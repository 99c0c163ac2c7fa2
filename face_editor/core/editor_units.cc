// Units' fields: how far each unit moves which skin.

#include <fmt/format.h>

#include <algorithm>

#include "face_editor/core/editor.h"
#include "fsm/base/table_reader.h"
#include "fsm/motion/base/motion_errors.h"

namespace editor {

using vm::Errc;
using vm::Fail;

vm::Result<void> CheckUnit(int unit) {
  if (fsm::UnitNames::BuiltIn().IsUnit(unit)) return {};
  return Fail(Errc::kBadValue,
              fmt::format("{} is no action unit; 1 to 46 without 3 and 40 expected", unit));
}

vm::Result<std::size_t> Editor::RowOf(int unit, int row) const {
  if (auto fits = CheckUnit(unit); !fits) return std::unexpected(fits.error());
  const auto rows = RowsOf(state().units->rows, unit);
  if (row < 1 || row > static_cast<int>(rows.size())) {
    return Fail(Errc::kBadValue,
                fmt::format("unit {} has no row {}; there are {}", unit, row, rows.size()));
  }
  return rows[static_cast<std::size_t>(row - 1)];
}

vm::Result<void> Editor::ChangeRows(UnitRows rows, const std::string& what,
                                    std::string_view merge) {
  auto units = WithRows(*state().units, std::move(rows));
  if (!units) return std::unexpected(units.error());
  history_.Change(Part::kUnits, what, merge, [&](State& state) { state.units = *units; });
  return {};
}

vm::Result<void> Editor::SetRow(int unit, int row, std::string_view column,
                                const std::string& value, std::string_view merge) {
  const auto at = RowOf(unit, row);
  if (!at) return std::unexpected(at.error());
  UnitRows rows = state().units->rows;
  const UnitRowKind& kind = *KindOf(rows[*at]);  // it was read
  const auto found = std::ranges::find(kind.columns, column, &UnitColumn::name);
  if (found == kind.columns.end()) {
    std::string names;
    for (const auto& other : kind.columns) {
      names += (names.empty() ? "" : ", ") + std::string(other.name);
    }
    return Fail(Errc::kBadValue,
                fmt::format("row {} of unit {} is a {} and has no '{}'; {}", row, unit, kind.word,
                            column.substr(0, 40),
                            names.empty() ? "nothing of it can be set" : names + " expected"));
  }
  const auto word = kind.first + static_cast<std::size_t>(found - kind.columns.begin());
  const bool one_word = !value.empty() && value.find_first_of(" \t\r\n#") == std::string::npos;
  if (!one_word || value.size() > 40) return Fail(Errc::kBadValue, "one word or number expected");
  auto& words = rows[*at].words;
  if (word == words.size()) words.emplace_back();  // the last number of a crease, left out before
  words[word] = value;
  return ChangeRows(std::move(rows), fmt::format("unit {}, {} {}", unit, kind.word, column), merge);
}

vm::Result<void> Editor::AddRow(int unit, std::string_view word, const std::string& values) {
  if (auto fits = CheckUnit(unit); !fits) return fits;
  const auto kind = std::ranges::find(UnitRowKinds(), word, &UnitRowKind::word);
  if (kind == UnitRowKinds().end()) {
    std::string names;
    for (const auto& other : UnitRowKinds()) names += " " + std::string(other.word);
    return Fail(Errc::kBadValue,
                fmt::format("'{}' found; one of{} expected", word.substr(0, 40), names));
  }
  if (values.find_first_of("\r\n#") != std::string::npos) {
    return Fail(Errc::kBadValue, "numbers of one row expected");
  }
  const fsm::Table table(
      "", fmt::format("{} {} {}", word, unit, values.empty() ? kind->example : values));
  UnitRow row;
  row.words = table.rows()[0].words();
  UnitRows rows = state().units->rows;
  rows.push_back(std::move(row));
  return ChangeRows(std::move(rows), fmt::format("unit {}, another {}", unit, word), "");
}

vm::Result<void> Editor::RemoveRow(int unit, int row) {
  const auto at = RowOf(unit, row);
  if (!at) return std::unexpected(at.error());
  UnitRows rows = state().units->rows;
  rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(*at));
  return ChangeRows(std::move(rows), fmt::format("unit {}, row {} removed", unit, row), "");
}

}  // namespace editor
