#include "face_editor/core/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>

#include "face_editor/core/command_actions.h"
#include "fsm/motion/base/unit_names.h"

namespace editor {
namespace {

using vm::Errc;
using namespace actions;

/// A command: its first words, what follows (capitals stand for values, [X] may be left out), and
/// what it does with what follows.
struct Command {
  std::vector<std::string_view> name;
  std::string_view values;
  std::size_t least, most;
  std::function<Answer(Editor&, const Words&)> run;
};
constexpr std::size_t kAny = 1000;

const std::vector<Command>& Commands() {
  using E = Editor&;
  using W = const Words&;
  const auto pattern_of = [](E editor, W w, auto remove) -> Answer {
    const auto pattern = Whole(w[1]);
    if (!pattern) return std::unexpected(pattern.error());
    return Done(remove(editor, w[0], *pattern));
  };
  static const std::vector<Command> commands = {
      {{"open"},
       "PHOTO [FACE]",
       1,
       2,
       [](E e, W w) -> Answer {
         const auto face = w.size() == 2 ? Whole(w[1]) : vm::Result<int>(1);
         if (!face) return std::unexpected(face.error());
         return Done(e.OpenPhoto(w[0], *face));
       }},
      {{"load"}, "KIND FILE", 2, 2, [](E e, W w) { return LoadOrSave(e, w, false); }},
      {{"save"}, "KIND FILE", 2, 2, [](E e, W w) { return LoadOrSave(e, w, true); }},
      {{"select"}, "POINT|GROUP ...|none", 1, kAny, Select},
      {{"drag"}, "POINT|GROUP DX DY", 3, 3, DragPoints},
      {{"symmetry"}, "on|off", 1, 1, [](E e, W w) { return Switched(w[0], e.symmetric); }},
      {{"reach"}, "PERCENT", 1, 1, SetReach},
      {{"reset", "points"}, "", 0, 0, [](E e, W) { return Done(e.ResetPoints()); }},
      {{"undo"},
       "",
       0,
       0,
       [](E e, W) -> Answer {
         if (e.history().Undo()) return "";
         return vm::Fail(Errc::kBadValue, "there is nothing to take back");
       }},
      {{"redo"},
       "",
       0,
       0,
       [](E e, W) -> Answer {
         if (e.history().Redo()) return "";
         return vm::Fail(Errc::kBadValue, "there is nothing to do again");
       }},
      {{"build"},
       "NAME [FOLDER]",
       1,
       2,
       [](E e, W w) { return e.BuildFace(w[0], w.size() == 2 ? w[1] : ""); }},
      {{"view"},
       "PHOTO|none",
       1,
       1,
       [](E e, W w) -> Answer {
         if (w[0] != "none") return Done(e.AddSidePhoto(w[0]));
         e.RemoveSidePhotos();
         return "";
       }},
      {{"get", "views"}, "", 0, 0, GetViews},
      {{"set", "AU"}, "UNIT [L|R] PERCENT", 2, 3, SetUnit},
      {{"clear", "units"},
       "",
       0,
       0,
       [](E e, W) -> Answer {
         e.SetLook({}, "clear units");
         return "";
       }},
      {{"keep"}, "EXPRESSION PATTERN", 2, 2, KeepLook},
      {{"set", "expression"}, "NAME PATTERN LOOK", 2, kAny, SetExpression},
      {{"set", "timing"}, "NAME posed|elicited ONSET EYE BROW MOUTH", 6, 6, SetTiming},
      {{"add", "pattern"}, "EXPRESSION", 1, 1, [](E e, W w) { return Done(e.AddPattern(w[0])); }},
      {{"remove", "pattern"},
       "EXPRESSION PATTERN",
       2,
       2,
       [pattern_of](E e, W w) {
         return pattern_of(e, w,
                           [](E x, const std::string& n, int p) { return x.RemovePattern(n, p); });
       }},
      {{"set", "mouth"},
       "SHAPE PARAMETER VALUE",
       3,
       3,
       [](E e, W w) { return SetMouth(e, w, false); }},
      {{"set", "mouth28"},
       "SHAPE PARAMETER VALUE",
       3,
       3,
       [](E e, W w) { return SetMouth(e, w, true); }},
      {{"set", "key"},
       "KIND PATTERN KEY MS X Y Z",
       7,
       7,
       [](E e, W w) { return ChangeKey(e, w, KeyChange::kSet); }},
      {{"add", "key"},
       "KIND PATTERN MS X Y Z",
       6,
       6,
       [](E e, W w) { return ChangeKey(e, w, KeyChange::kAdd); }},
      {{"remove", "key"},
       "KIND PATTERN KEY",
       3,
       3,
       [](E e, W w) { return ChangeKey(e, w, KeyChange::kRemove); }},
      {{"add", "motion"}, "KIND", 1, 1, [](E e, W w) { return Done(e.AddCurve(w[0])); }},
      {{"remove", "motion"},
       "KIND PATTERN",
       2,
       2,
       [pattern_of](E e, W w) {
         return pattern_of(e, w,
                           [](E x, const std::string& n, int p) { return x.RemoveCurve(n, p); });
       }},
      {{"set", "base"}, "FACE", 1, 1, [](E e, W w) { return Done(e.SetBase(w[0])); }},
      {{"set", "slider"}, "SLIDER VALUE", 2, 2, SetSlider},
      {{"set", "row"}, "UNIT ROW COLUMN VALUE", 4, 4, SetRow},
      {{"add", "row"}, "UNIT KIND [VALUE ...]", 2, 12, AddRow},
      {{"remove", "row"}, "UNIT ROW", 2, 2, RemoveRow},
      {{"get", "rows"}, "UNIT", 1, 1, GetRows},
      {{"get", "slider"}, "SLIDER", 1, 1, GetSlider},
      {{"get", "point"}, "POINT|GROUP", 1, 1, GetPoint},
      {{"get", "look"},
       "",
       0,
       0,
       [](E e, W) -> Answer { return fsm::FormatLook(e.state().look, e.unit_names()); }},
      {{"get", "expression"}, "NAME PATTERN", 2, 2, GetExpression},
      {{"get", "mouth"}, "SHAPE", 1, 1, [](E e, W w) { return GetMouth(e, w, false); }},
      {{"get", "mouth28"}, "SHAPE", 1, 1, [](E e, W w) { return GetMouth(e, w, true); }},
      {{"get", "motion"}, "KIND PATTERN", 2, 2, GetMotion},
      {{"get", "unsaved"}, "", 0, 0, GetUnsaved}};
  return commands;
}

}  // namespace

vm::Result<std::vector<std::string>> CommandWords(std::string_view line) {
  std::vector<std::string> words;
  std::size_t i = 0;
  while (true) {
    i = line.find_first_not_of(" \t\r", i);
    if (i == std::string_view::npos || line[i] == '#') return words;
    if (line[i] == '"') {
      const std::size_t end = line.find('"', i + 1);
      if (end == std::string_view::npos) {
        return vm::Fail(Errc::kSyntax, "a closing \" expected", i + 1);
      }
      words.emplace_back(line.substr(i + 1, end - i - 1));
      i = end + 1;
    } else {
      const std::size_t end = std::min(line.find_first_of(" \t\r", i), line.size());
      words.emplace_back(line.substr(i, end - i));
      i = end;
    }
  }
}

std::optional<vm::Result<std::string>> RunCommand(Editor& editor,
                                                  const std::vector<std::string>& words) {
  for (const Command& command : Commands()) {
    const std::size_t n = command.name.size();
    if (words.size() < n || !std::equal(command.name.begin(), command.name.end(), words.begin())) {
      continue;
    }
    const Words values(words.begin() + static_cast<std::ptrdiff_t>(n), words.end());
    if (values.size() >= command.least && values.size() <= command.most) {
      return command.run(editor, values);
    }
    return vm::Fail(Errc::kSyntax,
                    fmt::format("{} {} expected", fmt::join(command.name, " "), command.values));
  }
  return std::nullopt;
}

}  // namespace editor
