#include "fsm/faces/table_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "fsm/base/table_reader.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/faces/table_names.h"
#include "fsm/head/face_channels.h"
#include "fsm/motion/base/unit_names.h"
#include "fsm/motion/inputs/motion_tables.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

/// Throws TableError for a row with an unknown unit. REQUIRES: a UnitTable was made from the table.
void CheckRows(const Table& table, const UnitNames& names) {
  for (const TableRow& row : table.rows()) {
    for (const std::size_t word : {1U, 2U}) {
      if (word == 2 && !UnitTable::IsRule(row.key())) continue;
      const int unit = row.Integer(word);
      if (names.IsUnit(unit)) continue;
      row.Refuse(
          names.names.contains(unit)
              ? fmt::format("{} is a code of head or eyes in {}, which moves no skin; a unit "
                            "expected",
                            unit, kUnitNamesTable)
              : fmt::format("no unit has the number {}; one of {} expected", unit,
                            kUnitNamesTable));
    }
  }
}

}  // namespace

std::string Listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), kMaxListed); ++i) {
    text += (i > 0 ? ", " : "") + words[i].substr(0, 60);
  }
  if (words.size() > kMaxListed) text += fmt::format(" and {} more", words.size() - kMaxListed);
  return Printable(std::move(text));
}

vm::Result<std::vector<std::string>> CheckTables(const TableFolder& folder) try {
  std::vector<std::string> notices;
  if (folder.empty()) return notices;
  std::vector<std::string_view> tables = MotionTables::Files();
  tables.insert(tables.end(), kHeadTables.begin(), kHeadTables.end());
  std::ranges::sort(tables);
  if (const auto unknown = folder.FilesBeside(tables); !unknown.empty()) {
    notices.push_back(
        fmt::format("'{}' has files that are not read, for no table has their name: "
                    "{}; there are {}",
                    folder.path(), Listed(unknown), fmt::join(tables, ", ")));
  }
  static_cast<void>(FeaturesIn(folder));
  const auto own_names = vm::OrThrow(folder.Find(kUnitNamesTable));
  const UnitNames names = own_names ? vm::OrThrow(ReadUnitNames(own_names->path, own_names->text))
                                    : UnitNames::BuiltIn();
  std::vector<int> moving = BuiltInUnits().Numbers();
  const auto own_units = vm::OrThrow(folder.Find(kUnitsTable));
  if (own_units) {
    const Table table(own_units->path, own_units->text);
    moving = UnitTable(table).Numbers();
    CheckRows(table, names);
  }
  std::vector<std::string> still;
  for (const auto& [number, name] : names.names) {
    if (!names.IsUnit(number) || std::ranges::binary_search(moving, number)) continue;
    still.push_back(fmt::format("{} {}", number, name));
  }
  if (!still.empty()) {
    notices.push_back(fmt::format(
        "units without rows in {} move nothing: {}",
        own_units ? "'" + own_units->path + "'" : fmt::format("the built-in {}", kUnitsTable),
        Listed(still)));
  }
  return notices;
} catch (const vm::Failure& failure) {
  return std::unexpected(failure.error);
} catch (const std::runtime_error& error) {
  return vm::Fail(vm::Errc::kBadValue, error.what());
}

}  // namespace fsm
