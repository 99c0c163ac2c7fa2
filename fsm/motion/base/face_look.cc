#include "fsm/motion/base/face_look.h"

#include <fmt/format.h>

#include <optional>

#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/motion/base/track.h"
#include "fsm/motion/base/unit_names.h"

namespace fsm {

FaceLook Mix(const FaceLook& a, const FaceLook& b, double share_of_b) {
  FaceLook out = a;
  const auto mix = [share_of_b](float& to, float from) { to = Mix(to, from, share_of_b); };
  for (const Side side : kSides) {
    ForEachUnit(out.au[side], b.au[side], mix);
    out.gaze[side] = Mix(a.gaze[side], b.gaze[side], share_of_b);
  }
  out.residuals = Mix(a.residuals, b.residuals, share_of_b);
  return out;
}

void AddTo(FaceLook& a, const FaceLook& b, double weight) {
  if (weight == 0) return;
  const auto add = [weight](float& to, float from) { to += static_cast<float>(weight * from); };
  for (const Side side : kSides) {
    ForEachUnit(a.au[side], b.au[side], add);
    for (std::size_t i = 0; i < a.gaze[side].size(); ++i) add(a.gaze[side][i], b.gaze[side][i]);
  }
  for (std::size_t i = 0; i < a.residuals.size(); ++i) add(a.residuals[i], b.residuals[i]);
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

}  // namespace

FaceLook ReadLook(const TableRow& row, std::size_t first, const UnitNames& names) {
  FaceLook units;
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

vm::Result<BlendShapes> ReadBlendShapes(const std::string& name, std::string_view text,
                                        const UnitNames& names) {
  return ReadTable(name, text, [&](const Table& table) {
    BlendShapes shapes;
    for (const TableRow& row : table.rows()) {
      const std::string& shape = row.Name(0, "a shape's name");
      if (!shapes.emplace(shape, ReadLook(row, 1, names)).second) {
        row.Fail("'" + shape + "' is here twice");
      }
    }
    return shapes;
  });
}

}  // namespace fsm
