// Commands on how far each unit moves which skin.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "face_editor/core/command_actions.h"

namespace editor::actions {

Answer SetRow(Editor& editor, const Words& words) {
  const auto unit = Whole(words[0]), row = Whole(words[1]);
  if (!unit) return std::unexpected(unit.error());
  if (!row) return std::unexpected(row.error());
  return Done(editor.SetRow(*unit, *row, words[2], words[3]));
}

Answer AddRow(Editor& editor, const Words& words) {
  const auto unit = Whole(words[0]);
  if (!unit) return std::unexpected(unit.error());
  const Words values(words.begin() + 2, words.end());
  return Done(editor.AddRow(*unit, words[1], fmt::format("{}", fmt::join(values, " "))));
}

Answer RemoveRow(Editor& editor, const Words& words) {
  const auto unit = Whole(words[0]), row = Whole(words[1]);
  if (!unit) return std::unexpected(unit.error());
  if (!row) return std::unexpected(row.error());
  return Done(editor.RemoveRow(*unit, *row));
}

Answer GetRows(Editor& editor, const Words& words) {
  const auto unit = Whole(words[0]);
  if (!unit) return std::unexpected(unit.error());
  if (auto fits = CheckUnit(*unit); !fits) return std::unexpected(fits.error());
  std::string text;
  int number = 0;
  for (const std::size_t i : RowsOf(editor.state().units->rows, *unit)) {
    text += fmt::format("{}{}: {}", text.empty() ? "" : "\n", ++number,
                        fmt::join(editor.state().units->rows[i].words, " "));
  }
  return text.empty() ? "nothing" : text;
}

}  // namespace editor::actions
