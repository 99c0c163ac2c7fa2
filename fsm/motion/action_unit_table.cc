#include "fsm/motion/action_unit_table.h"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "fsm/motion/table_text.h"
#include "fsm/motion/track.h"
#include "fsm/motion/unit_names.h"

namespace fsm {

ActionUnits Mix(const ActionUnits& a, const ActionUnits& b, double share_of_b) {
  ActionUnits out = a;
  const auto mix = [share_of_b](float& to, float from) { to = Mix(to, from, share_of_b); };
  Combine(out.left, b.left, mix);
  Combine(out.right, b.right, mix);
  out.gaze_left = Mix(a.gaze_left, b.gaze_left, share_of_b);
  out.gaze_right = Mix(a.gaze_right, b.gaze_right, share_of_b);
  return out;
}

void AddTo(ActionUnits& a, const ActionUnits& b, double weight) {
  if (weight == 0) return;
  const auto add = [weight](float& to, float from) { to += static_cast<float>(weight * from); };
  Combine(a.left, b.left, add);
  Combine(a.right, b.right, add);
  for (std::size_t i = 0; i < 2; ++i) {
    add(a.gaze_left[i], b.gaze_left[i]);
    add(a.gaze_right[i], b.gaze_right[i]);
  }
}

namespace {

// "DOWN,RIGHT" in degrees.
vm::Result<std::array<float, 2>> ReadAngles(std::string_view word) {
  const std::size_t comma = word.find(',');
  const auto down = ParseNumber(word.substr(0, comma));
  const auto right =
      comma == std::string_view::npos ? vm::Result<double>(0) : ParseNumber(word.substr(comma + 1));
  if (!down || !right || comma == std::string_view::npos) {
    return vm::Fail(vm::Errc::kBadValue, "DOWN,RIGHT in degrees expected");
  }
  return std::array<float, 2>{static_cast<float>(*down), static_cast<float>(*right)};
}

}  // namespace

vm::Result<ActionUnits> ReadUnits(const TableText& table, const TableLine& line, std::size_t first,
                                  const UnitNames& names) {
  ActionUnits units;
  for (std::size_t i = first; i < line.words.size(); ++i) {
    const std::string_view word = line.words[i];
    const std::size_t colon = word.find(':');
    if (colon == std::string_view::npos) {
      return table.Wrong(line.number, fmt::format("'{}' found, AU:WEIGHT expected", word));
    }
    const std::string_view key = word.substr(0, colon);
    if (key.starts_with("gaze")) {
      const auto angles = ReadAngles(word.substr(colon + 1));
      if (!angles || (key != "gaze" && key != "gazeL" && key != "gazeR")) {
        return table.Wrong(
            line.number, fmt::format("'{}' found, gaze[L|R]:DOWN,RIGHT in degrees expected", word));
      }
      if (key != "gazeR") units.gaze_left = *angles;
      if (key != "gazeL") units.gaze_right = *angles;
      continue;
    }
    const auto unit = ParseUnitName(key, names);
    if (!unit) return table.Wrong(line.number, unit.error().text);
    const auto weight = ParseNumber(word.substr(colon + 1));
    if (!weight || *weight < 0 || *weight > 2) {
      return table.Wrong(line.number, fmt::format("'{}' found, a weight from 0 to 2 expected",
                                                  word.substr(colon + 1)));
    }
    const auto index = static_cast<std::size_t>(unit->number);
    if (unit->left) units.left[index] = static_cast<float>(*weight);
    const bool only_left = unit->left && names.IsOneSided(unit->number);
    if (unit->right && !only_left) units.right[index] = static_cast<float>(*weight);
  }
  return units;
}

namespace {

/// Reads the numbers of units from `first` on, and calls `take(number)` with each.
template <typename Take>
vm::Result<void> ReadNumbers(const TableText& table, const TableLine& line, std::size_t first,
                             const UnitNames& names, const Take& take) {
  for (std::size_t i = first; i < line.words.size(); ++i) {
    const auto unit = ParseUnitName(line.words[i], names);
    if (!unit) return table.Wrong(line.number, unit.error().text);
    take(static_cast<std::size_t>(unit->number));
  }
  return {};
}

vm::Result<void> ReadPosition(const TableText& table, const TableLine& line, const UnitNames& names,
                              UnitList& list) {
  const auto position = table.Number(line, 1, "a position", 1, 200);
  if (!position) return std::unexpected(position.error());
  if (line.words.size() != 3) return table.Wrong(line.number, "three words expected");
  const auto place = static_cast<std::size_t>(*position);
  list.units.resize(std::max(list.units.size(), place));
  list.emotions.resize(list.units.size());
  if (line.words[0] == "emotion") {
    list.emotions[place - 1] = line.words[2];
    return {};
  }
  return ReadNumbers(table, line, 2, names,
                     [&](std::size_t unit) { list.units[place - 1] = static_cast<int>(unit); });
}

/// In which line of the table a unit got its region.
using RegionLines = std::map<std::size_t, int>;

vm::Result<void> ReadRegion(const TableText& table, const TableLine& line, Region region,
                            const UnitNames& names, UnitList& list, RegionLines& given) {
  std::optional<std::size_t> twice;
  auto read = ReadNumbers(table, line, 2, names, [&](std::size_t unit) {
    const bool fresh = given.try_emplace(unit, line.number).second;
    if (!fresh && list.RegionOf(unit) != region && !twice) twice = unit;
    if (unit >= list.regions.size()) list.regions.resize(unit + 1, Region::kMouth);
    list.regions[unit] = region;
  });
  if (!read || !twice) return read;
  return table.Wrong(line.number, fmt::format("unit {} has another region in line {}; one expected",
                                              *twice, given[*twice]));
}

vm::Result<void> ReadListLine(const TableText& table, const TableLine& line, const UnitNames& names,
                              UnitList& list, RegionLines& given) {
  constexpr std::array<std::string_view, kRegions> kRegionNames = {"eye", "brow", "mouth"};
  const std::string& kind = line.words[0];
  if (kind == "face" || kind == "emotion") return ReadPosition(table, line, names, list);
  if (kind == "opens") {
    return ReadNumbers(table, line, 1, names, [&](std::size_t unit) {
      if (unit >= list.opening.size()) list.opening.resize(unit + 1);
      list.opening[unit] = true;
    });
  }
  if (kind != "region" || line.words.size() < 3) {
    return table.Wrong(line.number,
                       "'" + kind + "' found; face, emotion, region or opens expected");
  }
  const auto region = std::ranges::find(kRegionNames, line.words[1]);
  if (region == kRegionNames.end()) {
    return table.Wrong(line.number, "'" + line.words[1] + "' found, eye, brow or mouth expected");
  }
  return ReadRegion(table, line, static_cast<Region>(region - kRegionNames.begin()), names, list,
                    given);
}

}  // namespace

vm::Result<UnitList> ReadUnitList(const std::string& name, std::string_view text,
                                  const UnitNames& names) {
  const TableText table(name, text);
  UnitList list;
  RegionLines given;
  for (const TableLine& line : table.lines()) {
    if (auto read = ReadListLine(table, line, names, list, given); !read) {
      return std::unexpected(read.error());
    }
  }
  return list;
}

vm::Result<BlendShapes> ReadBlendShapes(const std::string& name, std::string_view text,
                                        const UnitNames& names) {
  const TableText table(name, text);
  BlendShapes shapes;
  for (const TableLine& line : table.lines()) {
    if (auto named = table.Name(line, 0, "a shape's name"); !named) {
      return std::unexpected(named.error());
    }
    auto units = ReadUnits(table, line, 1, names);
    if (!units) return std::unexpected(units.error());
    if (!shapes.emplace(line.words[0], *units).second) {
      return table.Wrong(line.number, "'" + line.words[0] + "' is here twice");
    }
  }
  return shapes;
}

}  // namespace fsm
