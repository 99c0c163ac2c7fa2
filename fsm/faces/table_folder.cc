#include "fsm/faces/table_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "fsm/base/table_reader.h"
#include "fsm/faces/face_of_name.h"
#include "fsm/head/face_channels.h"
#include "fsm/motion/motion_tables.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

constexpr const char* kNamesFile = "action_unit_names.txt";

/// The names of all tables there are.
std::vector<std::string> TableNames() {
  std::vector<std::string> names{kUnitsFile, kAppearanceFile, kFeaturesFile};
  static_cast<void>(MotionTables::Load("", &names));
  std::ranges::sort(names);
  return names;
}

/// Files that nobody reads; hidden ones are left alone.
std::vector<std::string> UnknownFiles(const std::string& folder,
                                      const std::vector<std::string>& known) {
  std::vector<std::string> unknown;
  std::error_code code;
  for (std::filesystem::directory_iterator at(folder, code), end; !code && at != end;
       at.increment(code)) {
    std::string name = at->path().filename().string();
    if (name.starts_with('.') || !at->is_regular_file(code)) continue;
    if (!std::ranges::binary_search(known, name)) unknown.push_back(std::move(name));
  }
  std::ranges::sort(unknown);
  return unknown;
}

/// Every row must speak of units that there are. REQUIRES: rows that a UnitTable was made of.
void CheckRows(const Table& table, const UnitNames& names) {
  for (const TableRow& row : table.rows()) {
    const bool rule = row.key() == "damp" || row.key() == "oppose" || row.key() == "strongest";
    for (const std::size_t word : {1U, 2U}) {
      if (word == 2 && !rule) continue;
      const int unit = row.Integer(word);
      if (names.IsUnit(unit)) continue;
      row.Fail(
          names.names.contains(unit)
              ? fmt::format("{} is a code of head or eyes in {}, which moves no skin; a unit "
                            "expected",
                            unit, kNamesFile)
              : fmt::format("no unit has the number {}; one of {} expected", unit, kNamesFile));
    }
  }
}

}  // namespace

std::string Listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < std::min(words.size(), kMostListed); ++i) {
    text += (i > 0 ? ", " : "") + words[i].substr(0, 60);
  }
  if (words.size() > kMostListed) text += fmt::format(" and {} more", words.size() - kMostListed);
  return Printable(std::move(text));
}

std::optional<std::string> TableIn(const std::string& folder, const std::string& file) {
  const std::string path = folder + "/" + file;
  std::error_code error;
  if (folder.empty() || !std::filesystem::exists(path, error)) return std::nullopt;
  return vm::OrThrow(ReadTableFile(path));
}

vm::Result<std::vector<std::string>> CheckTables(const std::string& folder) try {
  std::vector<std::string> notices;
  std::error_code code;
  if (folder.empty() || !std::filesystem::is_directory(folder, code)) return notices;
  static_cast<void>(FeaturesIn(folder));
  const std::vector<std::string> known = TableNames();
  if (const auto unknown = UnknownFiles(folder, known); !unknown.empty()) {
    notices.push_back(
        fmt::format("'{}' has files that are not read, for no table has their name: "
                    "{}; there are {}",
                    folder, Listed(unknown), fmt::join(known, ", ")));
  }
  const auto own_names = TableIn(folder, kNamesFile);
  const UnitNames names = own_names
                              ? vm::OrThrow(ReadUnitNames(folder + "/" + kNamesFile, *own_names))
                              : UnitNames::BuiltIn();
  std::vector<int> moving = BuiltInUnits().Numbers();
  const auto own_units = TableIn(folder, kUnitsFile);
  if (own_units) {
    const Table table(folder + "/" + kUnitsFile, *own_units);
    moving = UnitTable(table).Numbers();
    CheckRows(table, names);
  }
  std::vector<std::string> still;
  for (const auto& [number, name] : names.names) {
    if (!names.IsUnit(number) || std::ranges::binary_search(moving, number)) continue;
    still.push_back(fmt::format("{} {}", number, name));
  }
  if (!still.empty()) {
    notices.push_back(fmt::format("units without rows in {} move nothing: {}",
                                  own_units ? "'" + folder + "/" + kUnitsFile + "'"
                                            : std::string("the built-in ") + kUnitsFile,
                                  Listed(still)));
  }
  return notices;
} catch (const std::runtime_error& error) {
  return vm::Fail(vm::Errc::kBadValue, error.what());
}

}  // namespace fsm
