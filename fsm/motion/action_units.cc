#include "fsm/motion/action_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/motion/track.h"
#include "fsm/motion/unit_names.h"

namespace fsm {

ActionUnits Mix(const ActionUnits& a, const ActionUnits& b, double share_of_b) {
  ActionUnits out = a;
  const auto mix = [share_of_b](float& to, float from) { to = Mix(to, from, share_of_b); };
  for (const Side side : kSides) {
    Combine(out.au[side], b.au[side], mix);
    out.gaze[side] = Mix(a.gaze[side], b.gaze[side], share_of_b);
  }
  return out;
}

void AddTo(ActionUnits& a, const ActionUnits& b, double weight) {
  if (weight == 0) return;
  const auto add = [weight](float& to, float from) { to += static_cast<float>(weight * from); };
  for (const Side side : kSides) {
    Combine(a.au[side], b.au[side], add);
    for (std::size_t i = 0; i < a.gaze[side].size(); ++i) add(a.gaze[side][i], b.gaze[side][i]);
  }
}

namespace {

/// Parses "DOWN,RIGHT", degrees.
std::optional<EyeAngles> ReadAngles(std::string_view word) {
  const std::size_t comma = word.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto down = ParseNumber(word.substr(0, comma));
  const auto right = ParseNumber(word.substr(comma + 1));
  if (!down || !right) return std::nullopt;
  return EyeAngles{static_cast<float>(*down), static_cast<float>(*right)};
}

UnitName UnitOf(const TableRow& row, std::string_view word, const UnitNames& names) {
  const auto unit = ParseUnitName(word, names);
  if (!unit) row.Fail(unit.error().text);
  return *unit;
}

/// Calls `take(number)` for each unit in the words of the row from index `first` on.
template <typename Take>
void ReadNumbers(const TableRow& row, std::size_t first, const UnitNames& names, const Take& take) {
  for (std::size_t i = first; i < row.size(); ++i) {
    take(static_cast<std::size_t>(UnitOf(row, row.Word(i), names).number));
  }
}

void ReadPosition(const TableRow& row, const UnitNames& names, UnitList& list) {
  const auto position = static_cast<std::size_t>(row.Number(1, "a position", 1, 200));
  if (row.size() != 3) row.Fail("three words expected");
  list.units.resize(std::max(list.units.size(), position));
  list.emotions.resize(list.units.size());
  if (row.key() == "emotion") {
    list.emotions[position - 1] = row.Word(2);
  } else {
    list.units[position - 1] = UnitOf(row, row.Word(2), names).number;
  }
}

/// The units whose region a row has set.
using RegionsGiven = std::set<std::size_t>;

void ReadRegion(const TableRow& row, Region region, const UnitNames& names, UnitList& list,
                RegionsGiven& given) {
  ReadNumbers(row, 2, names, [&](std::size_t unit) {
    if (!given.insert(unit).second && list.RegionOf(unit) != region) {
      row.Fail(fmt::format("unit {} has another region above; one expected", unit));
    }
    if (unit >= list.regions.size()) list.regions.resize(unit + 1, Region::kMouth);
    list.regions[unit] = region;
  });
}

void ReadListRow(const TableRow& row, const UnitNames& names, UnitList& list, RegionsGiven& given) {
  constexpr std::array<std::string_view, kRegions> kRegionNames = {"eye", "brow", "mouth"};
  const std::string& kind = row.key();
  if (kind == "face" || kind == "emotion") return ReadPosition(row, names, list);
  if (kind == "opens") {
    return ReadNumbers(row, 1, names, [&](std::size_t unit) {
      if (unit >= list.opening.size()) list.opening.resize(unit + 1);
      list.opening[unit] = true;
    });
  }
  if (kind != "region" || row.size() < 3) {
    row.Fail("'" + kind + "' found; face, emotion, region or opens expected");
  }
  const auto region = std::ranges::find(kRegionNames, row.Word(1));
  if (region == kRegionNames.end()) {
    row.Fail("'" + row.Word(1) + "' found, eye, brow or mouth expected");
  }
  ReadRegion(row, static_cast<Region>(region - kRegionNames.begin()), names, list, given);
}

}  // namespace

ActionUnits ReadUnits(const TableRow& row, std::size_t first, const UnitNames& names) {
  ActionUnits units;
  for (std::size_t i = first; i < row.size(); ++i) {
    const std::string_view word = row.Word(i);
    const std::size_t colon = word.find(':');
    if (colon == std::string_view::npos) {
      row.Fail(fmt::format("'{}' found, AU:WEIGHT expected", word));
    }
    const std::string_view key = word.substr(0, colon);
    const std::string_view value = word.substr(colon + 1);
    if (key.starts_with("gaze")) {
      const auto angles = ReadAngles(value);
      if (!angles || (key != "gaze" && key != "gazeL" && key != "gazeR")) {
        row.Fail(fmt::format("'{}' found, gaze[L|R]:DOWN,RIGHT in degrees expected", word));
      }
      if (key != "gazeR") units.gaze.left = *angles;
      if (key != "gazeL") units.gaze.right = *angles;
      continue;
    }
    const UnitName unit = UnitOf(row, key, names);
    const auto weight = ParseNumber(value);
    if (!weight || *weight < 0 || *weight > 2) {
      row.Fail(fmt::format("'{}' found, a weight from 0 to 2 expected", value));
    }
    const auto index = static_cast<std::size_t>(unit.number);
    if (unit.left) units.au.left[index] = static_cast<float>(*weight);
    const bool only_left = unit.left && names.IsOneSided(unit.number);
    if (unit.right && !only_left) units.au.right[index] = static_cast<float>(*weight);
  }
  return units;
}

vm::Result<UnitList> ReadUnitList(const std::string& name, std::string_view text,
                                  const UnitNames& names) {
  return ReadTable(name, text, [&](const Table& table) {
    UnitList list;
    RegionsGiven given;
    for (const TableRow& row : table.rows()) ReadListRow(row, names, list, given);
    return list;
  });
}

vm::Result<BlendShapes> ReadBlendShapes(const std::string& name, std::string_view text,
                                        const UnitNames& names) {
  return ReadTable(name, text, [&](const Table& table) {
    BlendShapes shapes;
    for (const TableRow& row : table.rows()) {
      const std::string& shape = row.Name(0, "a shape's name");
      if (!shapes.emplace(shape, ReadUnits(row, 1, names)).second) {
        row.Fail("'" + shape + "' is here twice");
      }
    }
    return shapes;
  });
}

}  // namespace fsm
