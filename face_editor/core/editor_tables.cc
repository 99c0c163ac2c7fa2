// The tables: movements of the head, and the files.

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

#include "embedded/editor_action_units.h"
#include "embedded/editor_emotions.h"
#include "embedded/editor_motions.h"
#include "embedded/editor_mouth_shapes.h"
#include "embedded/editor_mouth_shapes_28.h"
#include "face_editor/core/editor.h"
#include "face_editor/core/identity_head.h"
#include "face_editor/core/table_writer.h"
#include "fsm/base/table_reader.h"
#include "fsm/motion/base/motion_errors.h"
#include "fsm/motion/inputs/motion_reader.h"
#include "vm_protocol/core/text_file.h"

namespace editor {

using vm::Errc;
using vm::Fail;

namespace {

constexpr const char* kExpressionsFile = "emotions.txt";
constexpr const char* kShapes14File = "mouth_shapes.txt";
constexpr const char* kShapes28File = "mouth_shapes_28.txt";
constexpr const char* kMotionsFile = "motions.txt";
constexpr const char* kUnitsFile = "action_units.txt";

/// The text of a table in `folder`, else what the program carries.
std::string TextIn(const std::string& folder, const char* file, std::string_view built_in) {
  std::error_code code;
  const std::string path = folder + "/" + file;
  if (folder.empty() || !std::filesystem::exists(path, code)) return std::string(built_in);
  return fsm::ReadTableFile(path).value_or(std::string(built_in));
}

State First() {
  State state;
  for (const char* kind : {"NOD", "REFUSE", "LISTEN", "USERDEF"}) state.curves[kind];
  state.sliders = SlidersOf(state.base);
  return state;
}

}  // namespace

Editor::Editor(fsm::MotionTables tables) : tables_(std::move(tables)), history_(First()) {}

vm::Result<std::unique_ptr<Editor>> Editor::Make(const std::string& tables) {
  auto loaded = fsm::MotionTables::Load();
  if (!loaded) return std::unexpected(loaded.error());
  std::unique_ptr<Editor> editor(new Editor(std::move(*loaded)));
  auto units = ReadUnits(kUnitsFile, embedded::editor_action_units());
  if (!units) return std::unexpected(units.error());
  editor->built_in_units_ = std::move(*units);
  if (auto done = editor->LoadTables(tables); !done) return std::unexpected(done.error());
  return editor;
}

vm::Result<void> Editor::LoadTables(const std::string& folder) {
  auto tables = fsm::MotionTables::Load(folder);
  if (!tables) return std::unexpected(tables.error());
  auto units = UnitsIn(folder);
  if (!units) return std::unexpected(units.error());
  tables_ = std::move(*tables);
  expressions_text_ = TextIn(folder, kExpressionsFile, embedded::editor_emotions());
  shapes14_text_ = TextIn(folder, kShapes14File, embedded::editor_mouth_shapes());
  shapes28_text_ = TextIn(folder, kShapes28File, embedded::editor_mouth_shapes_28());
  motions_text_ = TextIn(folder, kMotionsFile, embedded::editor_motions());
  const auto put = [this](Part part, const std::function<void(State&)>& change) {
    history_.Restart(part, change);
    MarkSaved(part);
  };
  put(Part::kExpressions, [this](State& state) { state.expressions = tables_.expressions; });
  put(Part::kMouth, [this](State& state) {
    state.shapes14 = tables_.set(fsm::VisemeSetId::k14).visemes;
    state.shapes28 = tables_.set(fsm::VisemeSetId::k28).visemes;
  });
  put(Part::kUnits, [&](State& state) { state.units = *units; });
  put(Part::kMotions, [this](State& state) {
    for (auto& [kind, curves] : state.curves) {
      const auto read = tables_.motions.head.find(kind);
      curves = read == tables_.motions.head.end() ? std::vector<fsm::HeadCurve>{} : read->second;
    }
  });
  return {};
}

vm::Result<std::shared_ptr<const Units>> Editor::UnitsIn(const std::string& folder) const {
  std::error_code code;
  const std::string path = folder + "/" + kUnitsFile;
  if (folder.empty() || !std::filesystem::exists(path, code)) return built_in_units_;
  const auto text = fsm::ReadTableFile(path);
  if (!text) return std::unexpected(text.error());
  return ReadUnits(path, *text);
}

fsm::MotionTables Editor::Tables() const {
  fsm::MotionTables tables = tables_;
  tables.expressions = state().expressions;
  tables.set(fsm::VisemeSetId::k14).visemes = state().shapes14;
  tables.set(fsm::VisemeSetId::k28).visemes = state().shapes28;
  for (const auto& [kind, curves] : state().curves) tables.motions.head[kind] = curves;
  return tables;
}

vm::Result<void> Editor::Load(Part part, const std::string& path, bool bilingual) {
  if (part == Part::kPoints) return LoadPoints(path);
  auto text = fsm::ReadTableFile(path);
  if (!text) return std::unexpected(text.error());
  const auto put = [&](const std::string& what, const std::function<void(State&)>& change) {
    history_.Change(part, what, "", change);
    MarkSaved(part);
  };
  if (part == Part::kExpressions) {
    auto read = fsm::ReadExpressions(path, *text, unit_names());
    if (!read) return std::unexpected(read.error());
    expressions_text_ = std::move(*text);
    put("expressions read", [&](State& state) { state.expressions = std::move(*read); });
  } else if (part == Part::kMouth) {
    auto read =
        fsm::ReadVisemes(path, *text, bilingual ? fsm::VisemeSetId::k28 : fsm::VisemeSetId::k14);
    if (!read) return std::unexpected(read.error());
    // Phonemes and dominances know shapes by name and place.
    for (std::size_t i = 0; i < read->size(); ++i) {
      const auto& mine = shapes(bilingual)[i];
      if ((*read)[i].name != mine.name) {
        return Fail(Errc::kBadValue, fmt::format("{}: shape {} is '{}', '{}' expected", path, i + 1,
                                                 (*read)[i].name, mine.name));
      }
      (*read)[i].dominance = mine.dominance;
      (*read)[i].pose.contact = mine.pose.contact;
    }
    (bilingual ? shapes28_text_ : shapes14_text_) = std::move(*text);
    put("mouth shapes read",
        [&](State& state) { (bilingual ? state.shapes28 : state.shapes14) = std::move(*read); });
  } else if (part == Part::kMotions) {
    auto read = fsm::ReadMotions(path, *text, unit_names());
    if (!read) return std::unexpected(read.error());
    motions_text_ = std::move(*text);
    tables_.motions = *read;
    put("movements read", [&](State& state) {
      for (auto& [kind, curves] : state.curves) curves = read->head[kind];
    });
  } else if (part == Part::kUnits) {
    auto read = ReadUnits(path, *text);
    if (!read) return std::unexpected(read.error());
    put("units' fields read", [&](State& state) { state.units = *read; });
  } else {
    return Fail(Errc::kBadValue, "this part has no table of its own");
  }
  return {};
}

vm::Result<void> Editor::Save(Part part, const std::string& path, bool bilingual) {
  if (part == Part::kPoints) return SavePoints(path);
  std::string text;
  if (part == Part::kExpressions) {
    text = WriteExpressions(expressions_text_, state().expressions, unit_names());
  } else if (part == Part::kMouth) {
    text = WriteVisemes(bilingual ? shapes28_text_ : shapes14_text_, shapes(bilingual));
  } else if (part == Part::kMotions) {
    text = WriteCurves(motions_text_, state().curves);
  } else if (part == Part::kUnits) {
    text = WriteUnits(*state().units);
  } else {
    return Fail(Errc::kBadValue, "this part has no table of its own");
  }
  if (auto done = vm::WriteTextFile(path, text); !done) return done;
  const std::string& other = bilingual ? shapes14_text_ : shapes28_text_;
  // The other set of mouth shapes is a file of its own.
  if (part == Part::kMouth && WriteVisemes(other, shapes(!bilingual)) != other) return {};
  MarkSaved(part);
  return {};
}

vm::Result<int> Editor::SaveTables(const std::string& folder) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  struct File {
    const char* name;
    Part part;
    bool bilingual;
    std::string text;
    std::string_view built_in;
  };
  const File files[] = {
      {kExpressionsFile, Part::kExpressions, false,
       WriteExpressions(expressions_text_, state().expressions, unit_names()),
       embedded::editor_emotions()},
      {kShapes14File, Part::kMouth, false, WriteVisemes(shapes14_text_, state().shapes14),
       embedded::editor_mouth_shapes()},
      {kShapes28File, Part::kMouth, true, WriteVisemes(shapes28_text_, state().shapes28),
       embedded::editor_mouth_shapes_28()},
      {kMotionsFile, Part::kMotions, false, WriteCurves(motions_text_, state().curves),
       embedded::editor_motions()},
      {kUnitsFile, Part::kUnits, false, WriteUnits(*state().units),
       embedded::editor_action_units()}};
  int written = 0;
  for (const File& file : files) {
    const std::string path = folder + "/" + file.name;
    if (file.text == file.built_in && !std::filesystem::exists(path, code)) continue;
    if (auto done = vm::WriteTextFile(path, file.text); !done) return std::unexpected(done.error());
    ++written;
  }
  for (const Part part : {Part::kExpressions, Part::kMouth, Part::kMotions, Part::kUnits}) {
    MarkSaved(part);
  }
  return written;
}

vm::Result<void> CheckKeys(const Editor::Keys& keys) {
  double before = 0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto& key = keys[i];
    if (!(key.ms > before) || key.ms > 86400000) {
      return Fail(Errc::kBadValue,
                  fmt::format("key frame {} at {:g} ms is not after the one before "
                              "it ({:g} ms)",
                              i + 1, key.ms, before));
    }
    before = key.ms;
    for (const float angle : key.angles) {
      if (!(std::abs(angle) <= 180)) {
        return Fail(Errc::kBadValue,
                    fmt::format("key frame {}: angles from -180 to 180 expected", i + 1));
      }
    }
  }
  if (keys.empty()) return Fail(Errc::kBadValue, "a movement has at least one key frame");
  if (keys.size() > 1000) return Fail(Errc::kLimit, "at most 1000 key frames are edited");
  return {};
}

vm::Result<void> Editor::CheckCurve(std::string_view kind, int pattern) const {
  const auto found = state().curves.find(kind);
  if (found == state().curves.end()) {
    return Fail(Errc::kBadValue, fmt::format("there is no movement '{}'; {} expected",
                                             kind.substr(0, 40), fsm::KeysOf(state().curves)));
  }
  return fsm::CheckPatternNumber(kind, pattern, 1, found->second.size());
}

vm::Result<void> Editor::SetCurve(std::string_view kind, int pattern, const Keys& keys,
                                  std::string_view merge) {
  if (auto fits = CheckCurve(kind, pattern); !fits) return fits;
  if (auto fits = CheckKeys(keys); !fits) return fits;
  history_.Change(Part::kMotions, fmt::format("{} {}", kind, pattern), merge, [&](State& state) {
    state.curves.find(kind)->second[static_cast<std::size_t>(pattern - 1)] = fsm::HeadCurve(keys);
  });
  return {};
}

vm::Result<void> Editor::AddCurve(std::string_view kind) {
  const auto found = state().curves.find(kind);
  if (found == state().curves.end()) return CheckCurve(kind, 1);
  history_.Change(Part::kMotions, fmt::format("add {}", kind), "", [&](State& state) {
    auto& curves = state.curves.find(kind)->second;
    const fsm::HeadCurve first({{400, {10, 0, 0}}, {800, {0, 0, 0}}});
    curves.push_back(curves.empty() ? first : curves.back());
  });
  return {};
}

vm::Result<void> Editor::RemoveCurve(std::string_view kind, int pattern) {
  if (auto fits = CheckCurve(kind, pattern); !fits) return fits;
  history_.Change(Part::kMotions, fmt::format("remove {} {}", kind, pattern), "",
                  [&](State& state) {
                    auto& curves = state.curves.find(kind)->second;
                    curves.erase(curves.begin() + (pattern - 1));
                  });
  return {};
}

}  // namespace editor
