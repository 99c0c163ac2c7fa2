#include "fsm/motion/inputs/text_cues.h"

#include <algorithm>

#include "fsm/base/table_reader.h"
#include "vm_protocol/core/lower_case.h"

namespace fsm {
namespace {

constexpr std::size_t kMaxLooks = 100, kMaxCues = 1000;
constexpr float kMaxDegrees = 30;

TextLook ReadTextLook(const TableRow& row, const TextCues& cues, const UnitNames& names) {
  if (row.size() < 6 || (row.Word(2) != "ALL" && row.Word(2) != "END")) {
    row.Refuse("look NAME ALL|END DOWN TURN TILT AU:WEIGHT ... expected");
  }
  TextLook look{.name = row.Name(1, "a look"),
                .at_end = row.Word(2) == "END",
                .head_rotation = {},
                .look = {}};
  if (std::ranges::find(cues.looks, look.name, &TextLook::name) != cues.looks.end()) {
    row.Refuse("the look '" + look.name + "' is here twice");
  }
  if (cues.looks.size() == kMaxLooks) row.Refuse("more than 100 looks");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    look.head_rotation[axis] = row.Within(3 + axis, -kMaxDegrees, kMaxDegrees);
  }
  look.look = ReadLook(row, 6, names);
  return look;
}

TextCues::Cue ReadCue(const TableRow& row, const TextCues& cues) {
  if (row.size() < 3) row.Refuse("cue LOOK PHRASE | PHRASE ... expected");
  const auto look = std::ranges::find(cues.looks, row.Word(1), &TextLook::name);
  if (look == cues.looks.end()) row.Refuse("no look '" + row.Word(1) + "' found above");
  if (cues.cues.size() == kMaxCues) row.Refuse("more than 1000 cues");
  TextCues::Cue cue{static_cast<std::size_t>(look - cues.looks.begin()), {""}};
  for (std::size_t i = 2; i < row.size(); ++i) {
    if (row.Word(i) == "|") {
      cue.phrases.emplace_back();
    } else {
      cue.phrases.back() += (cue.phrases.back().empty() ? "" : " ") + vm::LowerCase(row.Word(i));
    }
  }
  if (std::ranges::find(cue.phrases, "") != cue.phrases.end()) {
    row.Refuse("nothing found beside a '|', a phrase expected");
  }
  return cue;
}

}  // namespace

vm::Result<TextCues> ReadTextCues(const std::string& name, std::string_view text,
                                  const UnitNames& names) {
  return ReadTable(name, text, [&](const Table& table) {
    TextCues cues;
    for (const TableRow& row : table.rows()) {
      if (row.key() == "look") {
        cues.looks.push_back(ReadTextLook(row, cues, names));
      } else if (row.key() == "cue") {
        cues.cues.push_back(ReadCue(row, cues));
      } else {
        row.Refuse("'" + row.key() + "' found, look or cue expected");
      }
    }
    return cues;
  });
}

}  // namespace fsm
