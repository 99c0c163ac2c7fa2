#include "fsm/motion/base/face_look.h"

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

FaceLook ReadLook(const TableRow& row, std::size_t first, const UnitNames& names) {
  if (row.size() <= first) return {};
  std::string
      text;  // with blanks for the words before, so that messages count columns as people do
  for (std::size_t i = 0; i < row.size(); ++i) {
    text += i < first ? std::string(row.Word(i).size() + 1, ' ') : row.Word(i) + " ";
  }
  const auto look = ParseLook(text, names);
  if (!look) row.Refuse(look.error().text);
  return *look;
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
