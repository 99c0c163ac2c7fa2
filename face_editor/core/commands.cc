#include "face_editor/core/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "fsm/motion/table_text.h"
#include "fsm/motion/unit_names.h"

namespace editor {
namespace {

using vm::Errc;
using Answer = vm::Result<std::string>;
using Words = std::vector<std::string>;

/// A command: its first words, what follows (capitals stand for values, [X] may be left out), and
/// what it does with what follows.
struct Command {
  std::vector<std::string_view> name;
  std::string_view values;
  std::size_t least, most;
  std::function<Answer(Editor&, const Words&)> run;
};
constexpr std::size_t kAny = 1000;

Answer Done(vm::Result<void> result) {
  if (!result) return std::unexpected(result.error());
  return "";
}

vm::Result<double> Number(const std::string& word) { return fsm::ParseNumber(word); }

vm::Result<int> Whole(const std::string& word) {
  const auto number = fsm::ParseNumber(word);
  if (!number || *number != static_cast<double>(static_cast<int>(*number))) {
    return vm::Fail(Errc::kBadValue, "'" + word + "' found, a whole number expected");
  }
  return static_cast<int>(*number);
}

vm::Result<std::vector<double>> Numbers(const Words& words, std::size_t first) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < words.size(); ++i) {
    const auto number = Number(words[i]);
    if (!number) return std::unexpected(number.error());
    numbers.push_back(*number);
  }
  return numbers;
}

Answer Switched(const std::string& word, bool& value) {
  if (word != "on" && word != "off") {
    return vm::Fail(Errc::kBadValue, "'" + word + "' found, on or off expected");
  }
  value = word == "on";
  return "";
}

Answer Select(Editor& editor, const Words& words) {
  std::set<int> selection;
  for (const std::string& word : words) {
    if (word == "none") continue;
    const auto points = PointsNamed(word);
    if (!points) return std::unexpected(points.error());
    selection.insert(points->begin(), points->end());
  }
  editor.selection = std::move(selection);
  return "";
}

Answer DragPoints(Editor& editor, const Words& words) {
  const auto points = PointsNamed(words[0]);
  if (!points) return std::unexpected(points.error());
  const auto by = Numbers(words, 1);
  if (!by) return std::unexpected(by.error());
  if (!editor.work()) return vm::Fail(Errc::kBadValue, "open a photo first");
  if (std::abs((*by)[0]) > 10000 || std::abs((*by)[1]) > 10000) {
    return vm::Fail(Errc::kBadValue, "pixels from -10000 to 10000 expected");
  }
  editor.selection = *points;
  editor.DragSelection(editor.state().points, {(*by)[0], (*by)[1]}, "");
  return "";
}

Answer SetUnit(Editor& editor, const Words& words) {
  const auto unit = fsm::ParseUnitName(words[0] + (words.size() == 3 ? words[1] : ""));
  if (!unit) return std::unexpected(unit.error());
  const auto percent = Number(words.back());
  if (!percent) return std::unexpected(percent.error());
  return Done(
      editor.SetUnit(unit->number, unit->left, unit->right, static_cast<float>(*percent / 100)));
}

Answer SetExpression(Editor& editor, const Words& words) {
  const auto pattern = Whole(words[1]);
  if (!pattern) return std::unexpected(pattern.error());
  std::string text;
  for (std::size_t i = 2; i < words.size(); ++i) text += (i > 2 ? " " : "") + words[i];
  const auto look = fsm::ParseLook(text, editor.unit_names());
  if (!look) return std::unexpected(look.error());
  return Done(editor.SetExpression(words[0], *pattern, *look));
}

Answer KeepLook(Editor& editor, const Words& words) {
  const auto pattern = Whole(words[1]);
  if (!pattern) return std::unexpected(pattern.error());
  return Done(editor.SetExpression(words[0], *pattern, editor.state().look));
}

Answer SetTiming(Editor& editor, const Words& words) {
  const auto v = Numbers(words, 2);
  if (!v) return std::unexpected(v.error());
  if (words[1] != "posed" && words[1] != "elicited") {
    return vm::Fail(Errc::kBadValue, "'" + words[1] + "' found, posed or elicited expected");
  }
  return Done(
      editor.SetTiming(words[0], words[1] == "posed", {(*v)[0], {(*v)[1], (*v)[2], (*v)[3]}}));
}

Answer SetMouth(Editor& editor, const Words& words, bool bilingual) {
  const fsm::MouthShape* found = fsm::FindShape(editor.shapes(bilingual), words[0]);
  fsm::MouthShape shape;
  if (found) shape = *found;
  shape.name = words[0];
  const auto value = Number(words[2]);
  if (!value) return std::unexpected(value.error());
  const auto number = static_cast<float>(*value);
  const auto parameter = fsm::ParseNumber(words[1]);
  if (words[1] == "seal") {
    shape.pose.seal = number;
  } else if (words[1] == "tongue") {
    shape.pose.tongue = number;
  } else if (words[1] == "hold") {
    shape.hold = *value;
  } else if (parameter && *parameter >= 1 && *parameter <= fsm::kMouthParameters) {
    shape.pose.mouth[static_cast<std::size_t>(*parameter) - 1] = number;
  } else {
    return vm::Fail(Errc::kBadValue,
                    "'" + words[1] + "' found; 1 to 17, seal, tongue or hold expected");
  }
  return Done(editor.SetShape(bilingual, shape));
}

/// The keys of a movement, for a change of one of them.
vm::Result<Editor::Keys> KeysOf(const Editor& editor, const std::string& kind, int pattern) {
  const auto found = editor.state().curves.find(kind);
  if (found == editor.state().curves.end() || pattern < 1 ||
      pattern > static_cast<int>(found->second.size())) {
    return vm::Fail(Errc::kBadValue,
                    "there is no movement " + kind + " " + std::to_string(pattern));
  }
  const auto keys = found->second[static_cast<std::size_t>(pattern - 1)].keys();
  return Editor::Keys(keys.begin(), keys.end());
}

enum class KeyChange { kSet, kAdd, kRemove };

Answer ChangeKey(Editor& editor, const Words& words, KeyChange change) {
  const auto v = Numbers(words, 1);
  if (!v) return std::unexpected(v.error());
  const int pattern = static_cast<int>((*v)[0]);
  auto keys = KeysOf(editor, words[0], pattern);
  if (!keys) return std::unexpected(keys.error());
  std::size_t next = 1;
  std::size_t index = keys->size();
  if (change != KeyChange::kAdd) {
    const double asked = (*v)[next++];
    if (asked < 1 || asked > static_cast<double>(keys->size())) {
      return vm::Fail(Errc::kBadValue, fmt::format("there is no key frame {:g}; 1 to {} expected",
                                                   asked, keys->size()));
    }
    index = static_cast<std::size_t>(asked) - 1;
  }
  if (change == KeyChange::kRemove) {
    keys->erase(keys->begin() + static_cast<std::ptrdiff_t>(index));
  } else {
    const auto f = [&](std::size_t i) { return static_cast<float>((*v)[next + i]); };
    const fsm::HeadCurve::Key key{(*v)[next], {f(1), f(2), f(3)}};
    if (change == KeyChange::kSet) {
      (*keys)[index] = key;
    } else {
      keys->push_back(key);
      std::ranges::sort(*keys, {}, &fsm::HeadCurve::Key::ms);
    }
  }
  return Done(editor.SetCurve(words[0], pattern, *keys));
}

struct FileKind {
  std::string_view word;
  Part part;
  bool bilingual;
};
constexpr FileKind kFiles[] = {{"points", Part::kPoints, false},
                               {"emotions", Part::kEmotions, false},
                               {"mouth", Part::kMouth, false},
                               {"mouth28", Part::kMouth, true},
                               {"motions", Part::kMotions, false}};

Answer LoadOrSave(Editor& editor, const Words& words, bool save) {
  if (words[0] == "tables") {
    if (!save) return Done(editor.LoadTables(words[1]));
    const auto count = editor.SaveTables(words[1]);
    if (!count) return std::unexpected(count.error());
    return fmt::format("{} tables written to {}", *count, words[1]);
  }
  const auto kind = std::ranges::find(kFiles, words[0], &FileKind::word);
  if (kind == std::end(kFiles)) {
    return vm::Fail(Errc::kBadValue, "'" + words[0] +
                                         "' found; points, emotions, mouth, mouth28, motions or "
                                         "tables expected");
  }
  return Done(save ? editor.Save(kind->part, words[1], kind->bilingual)
                   : editor.Load(kind->part, words[1], kind->bilingual));
}

Answer GetPoint(Editor& editor, const Words& words) {
  const auto points = PointsNamed(words[0]);
  if (!points) return std::unexpected(points.error());
  std::string text;
  for (const int i : *points) {
    const auto at = editor.state().points.find(i);
    if (at == editor.state().points.end()) continue;
    text += fmt::format("{}{} {:.2f} {:.2f}", text.empty() ? "" : "\n", PointName(i), at->second.x,
                        at->second.y);
  }
  if (text.empty()) return vm::Fail(Errc::kBadValue, "there is no photo with such a point");
  return text;
}

Answer GetExpression(Editor& editor, const Words& words) {
  const auto pattern = Whole(words[1]);
  const auto found = editor.state().emotions.find(words[0]);
  if (!pattern || found == editor.state().emotions.end() || *pattern < 1 ||
      *pattern > static_cast<int>(found->second.patterns.size())) {
    return vm::Fail(Errc::kBadValue, "there is no expression " + words[0] + " " + words[1]);
  }
  return fsm::FormatLook(found->second.patterns[static_cast<std::size_t>(*pattern - 1)]);
}

Answer GetMotion(Editor& editor, const Words& words) {
  const auto pattern = Whole(words[1]);
  if (!pattern) return std::unexpected(pattern.error());
  const auto keys = KeysOf(editor, words[0], *pattern);
  if (!keys) return std::unexpected(keys.error());
  std::string text;
  for (const auto& key : *keys) {
    text += fmt::format("{}{:g} {:g} {:g} {:g}", text.empty() ? "" : "\n", key.ms, key.angles[0],
                        key.angles[1], key.angles[2]);
  }
  return text;
}

Answer GetMouth(Editor& editor, const Words& words, bool bilingual) {
  const fsm::MouthShape* shape = fsm::FindShape(editor.shapes(bilingual), words[0]);
  if (!shape) return vm::Fail(Errc::kBadValue, "there is no mouth shape '" + words[0] + "'");
  return fsm::FormatShapeValues(*shape);
}

Answer GetUnsaved(Editor& editor, const Words&) {
  constexpr std::pair<Part, const char*> kNames[] = {{Part::kPoints, "points"},
                                                     {Part::kEmotions, "emotions"},
                                                     {Part::kMouth, "mouth"},
                                                     {Part::kMotions, "motions"}};
  std::string text;
  for (const auto& [part, name] : kNames) {
    if (editor.Unsaved(part)) text += (text.empty() ? "" : " ") + std::string(name);
  }
  return text.empty() ? "nothing" : text;
}

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
      {{"reach"},
       "PERCENT",
       1,
       1,
       [](E e, W w) -> Answer {
         const auto percent = Number(w[0]);
         if (!percent || *percent < 0 || *percent > 200) {
           return vm::Fail(Errc::kBadValue, "0 to 200 per cent of the eyes' distance expected");
         }
         e.reach01 = static_cast<float>(*percent / 100);
         return "";
       }},
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
      {{"get", "point"}, "POINT|GROUP", 1, 1, GetPoint},
      {{"get", "look"}, "", 0, 0, [](E e, W) -> Answer { return fsm::FormatLook(e.state().look); }},
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

std::optional<vm::Result<std::string>> RunCommand(Editor& editor, const Words& words) {
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
