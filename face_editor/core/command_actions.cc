#include "face_editor/core/command_actions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fsm/base/parse_number.h"
#include "fsm/motion/base/unit_names.h"

namespace editor::actions {

using vm::Errc;

namespace {

vm::Result<std::vector<double>> Numbers(const Words& words, std::size_t first) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < words.size(); ++i) {
    const auto number = Number(words[i]);
    if (!number) return std::unexpected(number.error());
    numbers.push_back(*number);
  }
  return numbers;
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

struct NamedFile {
  std::string_view word;
  Part part;
  bool bilingual;
};
constexpr NamedFile kFiles[] = {
    {"points", Part::kPoints, false},   {"emotions", Part::kExpressions, false},
    {"mouth", Part::kMouth, false},     {"mouth28", Part::kMouth, true},
    {"motions", Part::kMotions, false}, {"units", Part::kUnits, false}};

}  // namespace

Answer Done(vm::Result<void> result) {
  if (!result) return std::unexpected(result.error());
  return "";
}

vm::Result<double> Number(const std::string& word) {
  if (const auto number = fsm::ParseNumber(word)) return *number;
  return vm::Fail(Errc::kBadValue, "'" + word + "' is not a number");
}

vm::Result<int> Whole(const std::string& word) {
  const auto number = fsm::ParseNumber(word);
  if (!number || *number != static_cast<double>(static_cast<int>(*number))) {
    return vm::Fail(Errc::kBadValue, "'" + word + "' found, a whole number expected");
  }
  return static_cast<int>(*number);
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
  const auto unit =
      fsm::ParseUnitName(words[0] + (words.size() == 3 ? words[1] : ""), editor.unit_names());
  if (!unit) return std::unexpected(unit.error());
  const auto percent = Number(words.back());
  if (!percent) return std::unexpected(percent.error());
  return Done(editor.SetUnit(unit->number, unit->sides.left, unit->sides.right,
                             static_cast<float>(*percent / 100)));
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
  const fsm::Viseme* found = fsm::FindViseme(editor.shapes(bilingual), words[0]);
  fsm::Viseme shape;
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

Answer LoadOrSave(Editor& editor, const Words& words, bool save) {
  if (words[0] == "tables") {
    if (!save) return Done(editor.LoadTables(words[1]));
    const auto count = editor.SaveTables(words[1]);
    if (!count) return std::unexpected(count.error());
    return fmt::format("{} tables written to {}", *count, words[1]);
  }
  if (words[0] == "identity") {
    return save ? editor.SaveIdentity(words[1], "") : Done(editor.LoadIdentity(words[1], ""));
  }
  const auto kind = std::ranges::find(kFiles, words[0], &NamedFile::word);
  if (kind == std::end(kFiles)) {
    return vm::Fail(Errc::kBadValue, "'" + words[0] +
                                         "' found; points, emotions, mouth, mouth28, motions, "
                                         "units, identity or tables expected");
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

Answer GetViews(Editor& editor, const Words&) {
  std::string paths;
  for (const auto& side : editor.side_photos()) {
    paths += (paths.empty() ? "" : "\n") + side->path;
  }
  return paths.empty() ? "nothing" : paths;
}

Answer GetExpression(Editor& editor, const Words& words) {
  const auto pattern = Whole(words[1]);
  const auto found = editor.state().expressions.find(words[0]);
  if (!pattern || found == editor.state().expressions.end() || *pattern < 1 ||
      *pattern > static_cast<int>(found->second.patterns.size())) {
    return vm::Fail(Errc::kBadValue, "there is no expression " + words[0] + " " + words[1]);
  }
  return fsm::FormatLook(found->second.patterns[static_cast<std::size_t>(*pattern - 1)],
                         editor.unit_names());
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
  const fsm::Viseme* shape = fsm::FindViseme(editor.shapes(bilingual), words[0]);
  if (!shape) return vm::Fail(Errc::kBadValue, "there is no mouth shape '" + words[0] + "'");
  return fsm::FormatVisemeValues(*shape);
}

Answer GetUnsaved(Editor& editor, const Words&) {
  const std::string names = editor.UnsavedNames();
  return names.empty() ? "nothing" : names;
}

Answer SetReach(Editor& editor, const Words& words) {
  const auto percent = Number(words[0]);
  if (!percent || *percent < 0 || *percent > 200) {
    return vm::Fail(Errc::kBadValue, "0 to 200 per cent of the eyes' distance expected");
  }
  editor.reach01 = static_cast<float>(*percent / 100);
  return "";
}

Answer SetSlider(Editor& editor, const Words& words) {
  const auto value = Number(words[1]);
  if (!value) return std::unexpected(value.error());
  return Done(editor.SetSlider(words[0], static_cast<float>(*value)));
}

Answer GetSlider(Editor& editor, const Words& words) {
  const auto& sliders = editor.state().sliders;
  const auto slider = sliders.find(words[0]);
  return fmt::format("{:g}", slider == sliders.end() ? 0.0F : slider->second);
}

}  // namespace editor::actions
