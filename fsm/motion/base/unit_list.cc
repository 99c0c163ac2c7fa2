#include "fsm/motion/base/unit_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "fsm/base/table_reader.h"
#include "fsm/motion/base/unit_names.h"

namespace fsm {
namespace {

int UnitNumber(const TableRow& row, std::size_t word, const UnitNames& names) {
  const auto unit = ParseUnitName(row.Word(word), names);
  if (!unit) row.Refuse(unit.error().text);
  return unit->number;
}

/// Calls `take(number)` for each unit in the words of the row from index `first` on.
template <typename Take>
void ReadNumbers(const TableRow& row, std::size_t first, const UnitNames& names, const Take& take) {
  for (std::size_t i = first; i < row.size(); ++i) {
    take(static_cast<std::size_t>(UnitNumber(row, i, names)));
  }
}

void ReadPosition(const TableRow& row, const UnitNames& names, UnitList& list) {
  const auto position = static_cast<std::size_t>(row.Within<double>(1, 1, 200, "a position"));
  if (row.size() != 3) row.Refuse("three words expected");
  list.face_slots.resize(std::max(list.face_slots.size(), position));
  FaceSlot& slot = list.face_slots[position - 1];
  if (row.key() == "emotion") {
    slot.emotion = row.Word(2);
  } else {
    slot.unit = UnitNumber(row, 2, names);
  }
}

/// The units whose region a row has set.
using RegionsGiven = std::set<std::size_t>;

void ReadRegion(const TableRow& row, Region region, const UnitNames& names, UnitRegions& out,
                RegionsGiven& given) {
  ReadNumbers(row, 2, names, [&](std::size_t unit) {
    if (!given.insert(unit).second && out.RegionOf(unit) != region) {
      row.Refuse(fmt::format("unit {} has another region above; one expected", unit));
    }
    if (unit >= out.regions.size()) out.regions.resize(unit + 1, Region::kMouth);
    out.regions[unit] = region;
  });
}

void ReadListRow(const TableRow& row, const UnitNames& names, UnitList& list, RegionsGiven& given) {
  constexpr std::array<std::string_view, kRegions> kRegionNames = {"eye", "brow", "mouth"};
  const std::string& kind = row.key();
  if (kind == "face" || kind == "emotion") return ReadPosition(row, names, list);
  if (kind == "opens") {
    return ReadNumbers(row, 1, names, [&](std::size_t unit) {
      std::vector<bool>& opens = list.regions.opens;
      if (unit >= opens.size()) opens.resize(unit + 1);
      opens[unit] = true;
    });
  }
  if (kind != "region" || row.size() < 3) {
    row.Refuse("'" + kind + "' found; face, emotion, region or opens expected");
  }
  const auto region = std::ranges::find(kRegionNames, row.Word(1));
  if (region == kRegionNames.end()) {
    row.Refuse("'" + row.Word(1) + "' found, eye, brow or mouth expected");
  }
  ReadRegion(row, static_cast<Region>(region - kRegionNames.begin()), names, list.regions, given);
}

}  // namespace

vm::Result<UnitList> ReadUnitList(const std::string& name, std::string_view text,
                                  const UnitNames& names) {
  return ReadTable(name, text, [&](const Table& table) {
    UnitList list;
    RegionsGiven given;
    for (const TableRow& row : table.rows()) ReadListRow(row, names, list, given);
    return list;
  });
}

}  // namespace fsm
