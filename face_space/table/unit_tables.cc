#include "face_space/table/unit_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "embedded/base_action_unit_list.h"
#include "embedded/base_action_unit_names.h"
#include "embedded/base_action_units.h"
#include "fsm/base/table_reader.h"
#include "fsm/motion/base/unit_names.h"
#include "vm_protocol/core/lower_case.h"

namespace facespace {
namespace {

constexpr const char *kRowsFile = "action_units.txt", *kNamesFile = "action_unit_names.txt",
                     *kListFile = "action_unit_list.txt";
constexpr std::size_t kMostRowsOfUnit = 40, kFewestRowsOfUnit = 5;

/// The part of the face a unit belongs to: where most of its movement lies.
std::string_view RegionOf(const WrittenUnit& unit) {
  double brow = 0, eye = 0, mouth = 0;
  for (const RowFitter::Part& part : unit.parts) {
    const UnitRows& rows = part.rows;
    for (const auto& field : rows.fields) {
      const double size = static_cast<double>(glm::dot(field.displacement, field.displacement) *
                                              field.radius.x * field.radius.y);
      (field.centre.y > 26 ? brow : field.centre.y > -2 ? eye : mouth) += size;
    }
    eye += 200 * (rows.lid_upper_mm * rows.lid_upper_mm + rows.lid_lower_mm * rows.lid_lower_mm);
    mouth += 200 * rows.jaw_degrees;
  }
  return mouth >= std::max(brow, eye) ? "mouth" : brow >= eye ? "brow" : "eye";
}

bool Opens(const WrittenUnit& unit) {
  return std::ranges::any_of(unit.parts,
                             [](const auto& part) { return part.rows.jaw_degrees > 3; });
}

}  // namespace

vm::Result<std::string> BaseTable(const std::string& folder, const char* file,
                                  std::string_view built_in) {
  const std::string path = folder + "/" + file;
  std::error_code code;
  if (folder.empty() || !std::filesystem::exists(path, code)) return std::string(built_in);
  return fsm::ReadTableFile(path);
}

vm::Result<UnitTables> WriteUnits(const std::vector<ShapeUnit>& shapes, const Placement& placement,
                                  const fsm::Head& head, const TableBase& base) {
  auto rows = BaseTable(base.folder, kRowsFile, embedded::base_action_units());
  auto names = BaseTable(base.folder, kNamesFile, embedded::base_action_unit_names());
  auto list = BaseTable(base.folder, kListFile, embedded::base_action_unit_list());
  for (const auto* text : {&rows, &names, &list}) {
    if (!*text) return std::unexpected(text->error());
  }
  const auto known = fsm::ReadUnitNames(base.folder + "/" + kNamesFile, *names);
  if (!known) return std::unexpected(known.error());
  const auto have = fsm::ReadTable(base.folder + "/" + kRowsFile, *rows,
                                   [](const fsm::Table& table) { return table.rows().size(); });
  if (!have) return std::unexpected(have.error());
  const std::size_t room = fsm::UnitTable::kMaxRows - std::min(*have, fsm::UnitTable::kMaxRows);
  const std::size_t each =
      std::min(kMostRowsOfUnit, room / std::max<std::size_t>(1, shapes.size()));
  if (each < kFewestRowsOfUnit) {
    return vm::Fail(vm::Errc::kLimit,
                    fmt::format("{} units share {} rows, at least {} each are needed; "
                                "keep fewer (--vectors)",
                                shapes.size(), room, kFewestRowsOfUnit));
  }
  const RowFitter fitter(head, placement.vertices);
  UnitTables out;
  const std::string from = "\n# Of recordings, by face_space units (docs/face_space.md).\n";
  for (auto* text : {&rows, &names, &list}) {
    if (!(*text)->ends_with('\n')) **text += '\n';
    **text += from;
  }
  int number = base.first_number;
  for (const ShapeUnit& shape : shapes) {
    const Eigen::VectorXd moves = placement.OnHead(shape.moves);
    WrittenUnit unit{.name = shape.name,
                     .number = 0,
                     .in_command = {},
                     .parts = fitter.Fit(moves, each),
                     .missing = {}};
    unit.missing = fitter.Check(unit.parts, moves);
    for (const RowFitter::Part& part : unit.parts) {
      while (known->names.contains(number)) ++number;
      if (number > static_cast<int>(fsm::UnitValues::kMax)) {
        return vm::Fail(vm::Errc::kLimit,
                        "no number up to 999 is left for another unit; begin lower (--first)");
      }
      const bool whole = part.acting == Acting::kBothSides, left = part.acting == Acting::kLeftOnly;
      const std::string name = shape.name + (whole ? "" : left ? "OnLeft" : "OnRight");
      if (known->by_name.contains(vm::LowerCase(name))) {
        return vm::Fail(vm::Errc::kBadValue,
                        fmt::format("{} has a unit called {} already", kNamesFile, name));
      }
      *rows += fmt::format("# {}\n", name) + part.rows.Text(number);
      *names += fmt::format("unit {} {}\n", number, name);
      unit.number = unit.number == 0 ? number : unit.number;
      unit.in_command += fmt::format("{}{}{}", unit.in_command.empty() ? "" : " ", number,
                                     whole  ? ""
                                     : left ? "L"
                                            : "R");
      *list += fmt::format("region {} {}\n", RegionOf(unit), number);
      if (Opens(unit)) *list += fmt::format("opens {}\n", number);
      ++number;
    }
    out.units.push_back(std::move(unit));
  }
  out.files = {{kRowsFile, *rows}, {kNamesFile, *names}, {kListFile, *list}};
  return out;
}

}  // namespace facespace
