#include "fsm/motion/action_unit_table.h"

#include <fmt/format.h>

#include <charconv>

#include "fsm/motion/table_text.h"
#include "fsm/motion/track.h"

namespace fsm {

namespace {

/// Calls `change(a's strength, b's strength)` for every unit that either has, the highest first: so
/// `a` grows no more than once.
template <typename Change>
void ForEachUnit(UnitValues& a, const UnitValues& b, const Change& change) {
  for (std::size_t unit = std::max(a.size(), b.size()); unit-- > 0;) change(a[unit], b[unit]);
}

}  // namespace

ActionUnits Mix(const ActionUnits& a, const ActionUnits& b, double share_of_b) {
  ActionUnits out = a;
  const auto mix = [share_of_b](float& to, float from) { to = Mix(to, from, share_of_b); };
  ForEachUnit(out.left, b.left, mix);
  ForEachUnit(out.right, b.right, mix);
  out.gaze_left = Mix(a.gaze_left, b.gaze_left, share_of_b);
  out.gaze_right = Mix(a.gaze_right, b.gaze_right, share_of_b);
  return out;
}

void AddTo(ActionUnits& a, const ActionUnits& b, double weight) {
  const auto add = [weight](float& to, float from) { to += static_cast<float>(weight * from); };
  ForEachUnit(a.left, b.left, add);
  ForEachUnit(a.right, b.right, add);
  for (std::size_t i = 0; i < 2; ++i) {
    add(a.gaze_left[i], b.gaze_left[i]);
    add(a.gaze_right[i], b.gaze_right[i]);
  }
}

bool IsActionUnit(int number) {
  return number >= 1 && number < static_cast<int>(kActionUnits) && number != 3 && number != 40;
}

bool IsOneSided(int number) { return number == 30 || number == 46; }

vm::Result<UnitName> ParseUnitName(std::string_view word) {
  UnitName unit;
  std::string_view digits = word;
  if (digits.ends_with('L') || digits.ends_with('l')) unit.right = false;
  if (digits.ends_with('R') || digits.ends_with('r')) unit.left = false;
  if (!unit.left || !unit.right) digits.remove_suffix(1);
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), unit.number);
  if (error != std::errc{} || end != digits.data() + digits.size() || !IsActionUnit(unit.number)) {
    return vm::Fail(
        vm::Errc::kBadValue,
        fmt::format("'{}' is not an action unit; 1 to 46 without 3 and 40 expected, with "
                    "L or R for one side",
                    word));
  }
  return unit;
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

vm::Result<ActionUnits> ReadUnits(const TableText& table, const TableLine& line,
                                  std::size_t first) {
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
    const auto unit = ParseUnitName(key);
    if (!unit) return table.Wrong(line.number, unit.error().text);
    const auto weight = ParseNumber(word.substr(colon + 1));
    if (!weight || *weight < 0 || *weight > 2) {
      return table.Wrong(line.number, fmt::format("'{}' found, a weight from 0 to 2 expected",
                                                  word.substr(colon + 1)));
    }
    const auto index = static_cast<std::size_t>(unit->number);
    if (unit->left) units.left[index] = static_cast<float>(*weight);
    const bool only_left = unit->left && IsOneSided(unit->number);
    if (unit->right && !only_left) units.right[index] = static_cast<float>(*weight);
  }
  return units;
}

vm::Result<UnitList> ReadUnitList(const std::string& name, std::string_view text) {
  const TableText table(name, text);
  UnitList list;
  list.region.fill(Region::kMouth);
  const auto make_room = [&list](std::size_t position) {
    if (list.units.size() < position) {
      list.units.resize(position);
      list.emotions.resize(position);
    }
  };
  for (const TableLine& line : table.lines()) {
    const std::string& kind = line.words[0];
    if (kind == "face" || kind == "emotion") {
      const auto position = table.Number(line, 1, "a position", 1, 200);
      if (!position) return std::unexpected(position.error());
      const auto place = static_cast<std::size_t>(*position);
      make_room(place);
      if (line.words.size() != 3) return table.Wrong(line.number, "three words expected");
      if (kind == "emotion") {
        list.emotions[place - 1] = line.words[2];
        continue;
      }
      const auto unit = ParseUnitName(line.words[2]);
      if (!unit) return table.Wrong(line.number, unit.error().text);
      list.units[place - 1] = unit->number;
    } else if (kind == "region" && line.words.size() > 2) {
      const std::string& part = line.words[1];
      if (part != "eye" && part != "brow" && part != "mouth") {
        return table.Wrong(line.number, "'" + part + "' found, eye, brow or mouth expected");
      }
      for (std::size_t i = 2; i < line.words.size(); ++i) {
        const auto unit = ParseUnitName(line.words[i]);
        if (!unit) return table.Wrong(line.number, unit.error().text);
        list.region[static_cast<std::size_t>(unit->number)] = part == "eye"    ? Region::kEye
                                                              : part == "brow" ? Region::kBrow
                                                                               : Region::kMouth;
      }
    } else if (kind == "opens") {
      for (std::size_t i = 1; i < line.words.size(); ++i) {
        const auto unit = ParseUnitName(line.words[i]);
        if (!unit) return table.Wrong(line.number, unit.error().text);
        list.opens[static_cast<std::size_t>(unit->number)] = true;
      }
    } else {
      return table.Wrong(line.number,
                         "'" + kind + "' found; face, emotion, region or opens expected");
    }
  }
  return list;
}

vm::Result<BlendShapes> ReadBlendShapes(const std::string& name, std::string_view text) {
  const TableText table(name, text);
  BlendShapes shapes;
  for (const TableLine& line : table.lines()) {
    if (auto named = table.Name(line, 0, "a shape's name"); !named) {
      return std::unexpected(named.error());
    }
    auto units = ReadUnits(table, line, 1);
    if (!units) return std::unexpected(units.error());
    if (!shapes.emplace(line.words[0], *units).second) {
      return table.Wrong(line.number, "'" + line.words[0] + "' is here twice");
    }
  }
  return shapes;
}

}  // namespace fsm
