#include "fsm/motion/base/face_look.h"

#include <fmt/format.h>

#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "fsm/base/words.h"
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

void SetUnit(FaceLook& look, const UnitSetting& unit) {
  const auto index = static_cast<std::size_t>(unit.number);
  for (const Side side : kSides) {
    if (unit.sides[side]) look.au[side][index] = static_cast<float>(unit.strength);
  }
}

bool SetGaze(FaceLook& look, std::string_view word) {
  const std::string_view key = ReadUntil(":", word);
  const auto down = ParseNumber(ReadUntil(",", word)), right = ParseNumber(word);
  if ((key != "gaze" && key != "gazeL" && key != "gazeR") || !down || !right) return false;
  const EyeAngles angles{static_cast<float>(*down), static_cast<float>(*right)};
  if (key != "gazeR") look.gaze.left = angles;
  if (key != "gazeL") look.gaze.right = angles;
  return true;
}

FaceLook ReadLook(const TableRow& row, std::size_t first, const UnitNames& names) {
  FaceLook look;
  for (std::size_t i = first; i < row.size(); ++i) {
    const std::string_view word = row.Word(i);
    if (word.starts_with("gaze")) {
      if (SetGaze(look, word)) continue;
      row.Refuse(fmt::format("'{}' found, gaze[L|R]:DOWN,RIGHT in degrees expected", word));
    }
    const std::size_t colon = word.find(':');
    if (colon == std::string_view::npos) {
      row.Refuse(fmt::format("'{}' found, AU:WEIGHT expected", word));
    }
    const auto unit = ParseUnitName(word.substr(0, colon), names);
    if (!unit) row.Refuse(unit.error().text);
    const std::string_view value = word.substr(colon + 1);
    const auto weight = ParseNumber(value);
    if (!weight || *weight < 0 || *weight > 2) {
      row.Refuse(fmt::format("'{}' found, a weight from 0 to 2 expected", value));
    }
    UnitSetting setting{*unit, *weight};
    KeepOwnSide(setting, names);
    SetUnit(look, setting);
  }
  return look;
}

vm::Result<BlendShapes> ReadBlendShapes(const std::string& name, std::string_view text,
                                        const UnitNames& names) {
  return ReadTable(name, text, [&](const Table& table) {
    BlendShapes shapes;
    for (const TableRow& row : table.rows()) {
      const std::string& shape = row.Name(0, "a shape's name");
      if (!shapes.emplace(shape, ReadLook(row, 1, names)).second) {
        row.Refuse("'" + shape + "' is here twice");
      }
    }
    return shapes;
  });
}

}  // namespace fsm
