#include "face_editor/core/editor.h"

#include <fmt/format.h>

#include <cmath>

#include "face_editor/core/table_writer.h"
#include "face_fit/find/face/hand_points.h"
#include "fsm/base/table_reader.h"
#include "fsm/faces/face_folder.h"
#include "fsm/mesh/original/pnt_file.h"
#include "fsm/motion/base/motion_errors.h"
#include "vm_protocol/core/text_file.h"

namespace editor {

using vm::Errc;
using vm::Fail;

bool Editor::Unsaved(Part part) const {
  const auto i = static_cast<std::size_t>(part);
  return state().version[i] != saved_[i];
}

std::string Editor::UnsavedNames() const {
  constexpr std::pair<Part, const char*> kNames[] = {
      {Part::kPoints, "points"},   {Part::kExpressions, "emotions"}, {Part::kMouth, "mouth"},
      {Part::kMotions, "motions"}, {Part::kUnits, "units"},          {Part::kIdentity, "identity"}};
  std::string text;
  for (const auto& [part, name] : kNames) {
    if (Unsaved(part)) text += (text.empty() ? "" : " ") + std::string(name);
  }
  return text;
}

void Editor::MarkSaved(Part part) {
  const auto i = static_cast<std::size_t>(part);
  saved_[i] = state().version[i];
}

vm::Result<void> Editor::OpenPhoto(const std::string& path, int face) {
  auto work = editor::OpenPhoto(models_.get(), path, face);
  if (!work) return std::unexpected(work.error());
  work_ = std::move(*work);
  sides_.clear();
  selection.clear();
  history_.Restart(Part::kPoints, [this](State& state) { state.points = work_->found; });
  MarkSaved(Part::kPoints);
  return {};
}

vm::Result<void> Editor::LoadPoints(const std::string& path) {
  if (!work_) return Fail(Errc::kBadValue, "open the photo before its points");
  auto text = vm::ReadTextFile(path, 1U << 20);
  if (!text) return std::unexpected(text.error());
  auto points = facefit::ParseHandPoints(path, *text);
  if (!points) return std::unexpected(points.error());
  const fsm::Image& photo = work_->front.photo.image;
  if (auto within = facefit::CheckWithin(*points, photo.width, photo.height); !within) {
    return Fail(within.error().code, path + ": " + within.error().text);
  }
  PointMap at;
  for (const auto& [i, place] : *points) at[static_cast<int>(i)] = glm::vec3(place, 0);
  if (work_->base) {
    const bool all = at.size() == work_->found.size();
    const PointMap whole = AllPoints(*work_, at);
    // Written by us, all are there: depth is then as it was found.
    for (const auto& [i, place] : whole) {
      at[i] = all ? glm::vec3(glm::vec2(at[i]), work_->found.at(i).z) : place;
    }
  }
  history_.Change(Part::kPoints, "points read", "", [&](State& state) { state.points = at; });
  MarkSaved(Part::kPoints);
  return {};
}

vm::Result<void> Editor::SavePoints(const std::string& path) {
  if (!work_) return Fail(Errc::kBadValue, "there are no points: open a photo first");
  if (auto done = vm::WriteTextFile(path, WritePoints(state().points)); !done) return done;
  MarkSaved(Part::kPoints);
  return {};
}

vm::Result<void> Editor::ResetPoints() {
  if (!work_) return Fail(Errc::kBadValue, "there are no points: open a photo first");
  history_.Change(Part::kPoints, "points as found", "",
                  [this](State& state) { state.points = work_->found; });
  return {};
}

void Editor::DragSelection(const PointMap& from, glm::vec2 by, std::string_view merge) {
  if (!work_ || selection.empty()) return;
  const Drag drag{selection, by, symmetric, reach01 * EyeDistance(from)};
  const std::string what =
      selection.size() == 1 ? "move " + PointName(*selection.begin()) : "move points";
  history_.Change(Part::kPoints, what, merge,
                  [&](State& state) { state.points = Dragged(from, work_->mirror, drag); });
}

vm::Result<std::string> Editor::BuildFace(const std::string& name, const std::string& folder) {
  if (!work_) return Fail(Errc::kBadValue, "there is no photo: open one first");
  if (!work_->base) return Fail(Errc::kUnavailable, work_->notice);
  const auto built = editor::BuildFace(*work_, state().points, models_.get(), sides_);
  if (!built) return std::unexpected(built.error());
  const facefit::MadeFace& made = (*built)->made;
  auto place = fsm::WriteFace(made.baked.head, made.report, folder, name);
  if (!place) return place;
  for (std::size_t i = 0; i < made.rejected.size(); ++i) {
    *place +=
        (i == 0 ? "; left out: " : "; ") + made.rejected[i].path + ": " + made.rejected[i].reason;
  }
  return place;
}

vm::Result<void> Editor::AddSidePhoto(const std::string& path) {
  if (!work_) return Fail(Errc::kBadValue, "open the photo from the front first");
  if (!work_->base || !models_) return Fail(Errc::kUnavailable, work_->notice);
  if (auto few = facefit::CheckSidePhotoCount(sides_.size() + 1); !few) return few;
  auto side = OpenSidePhoto(*models_, *work_, state().points, path);
  if (!side) return std::unexpected(side.error());
  sides_.push_back(std::move(*side));
  return {};
}

vm::Result<void> Editor::SetUnit(int unit, bool left, bool right, float strength,
                                 std::string_view merge) {
  if (auto fits = CheckUnit(unit); !fits) return fits;
  if (auto fits = fsm::CheckStrength(static_cast<double>(strength)); !fits) return fits;
  history_.Change(Part::kLook, fmt::format("unit {}", unit), merge, [&](State& state) {
    const auto i = static_cast<std::size_t>(unit);
    if (left) state.look.au.left[i] = strength;
    if (right) state.look.au.right[i] = strength;
  });
  return {};
}

void Editor::SetLook(const fsm::FaceLook& look, std::string what, std::string_view merge) {
  history_.Change(Part::kLook, std::move(what), merge, [&](State& state) { state.look = look; });
}

std::vector<fsm::FaceLook>* Editor::PatternsOf(State& state, std::string_view name) const {
  const auto found = state.expressions.find(name);
  return found == state.expressions.end() ? nullptr : &found->second.patterns;
}

vm::Result<void> Editor::CheckPattern(std::string_view name, int pattern) const {
  const auto found = state().expressions.find(name);
  if (found == state().expressions.end()) {
    return Fail(Errc::kBadValue, fmt::format("there is no expression '{}'; {} expected",
                                             name.substr(0, 40), fsm::KeysOf(state().expressions)));
  }
  return fsm::CheckPatternNumber(name, pattern, 1, found->second.patterns.size());
}

vm::Result<void> Editor::SetExpression(std::string_view name, int pattern,
                                       const fsm::FaceLook& look, std::string_view merge) {
  if (auto fits = CheckPattern(name, pattern); !fits) return fits;
  history_.Change(Part::kExpressions, fmt::format("{} {}", name, pattern), merge,
                  [&](State& state) {
                    (*PatternsOf(state, name))[static_cast<std::size_t>(pattern - 1)] = look;
                  });
  return {};
}

vm::Result<void> Editor::SetTiming(std::string_view name, bool posed,
                                   const fsm::Expression::Timing& timing, std::string_view merge) {
  if (auto fits = CheckPattern(name, 1); !fits) return fits;
  const auto within = [](double v, double most) { return v >= 0 && v <= most; };
  bool good = within(timing.onset_ms, 10000);
  for (const double lag : timing.lag_ms) good = good && within(lag, 1000);
  if (!good) return Fail(Errc::kBadValue, "an onset of 0 to 10000 ms, lags of 0 to 1000 expected");
  history_.Change(Part::kExpressions, fmt::format("times of {}", name), merge, [&](State& state) {
    auto& expression = state.expressions.find(name)->second;
    (posed ? expression.posed : expression.elicited) = timing;
  });
  return {};
}

vm::Result<void> Editor::AddPattern(std::string_view name) {
  const std::string word(name);
  const auto named = fsm::ReadTable("an expression", word, [](const fsm::Table& table) {
    if (table.rows().size() != 1 || table.rows().front().size() != 1) {
      table.Refuse("a name expected: a letter, then letters, digits and _");
    }
    return table.rows().front().Name(0, "a name");
  });
  if (!named) return std::unexpected(named.error());
  if (word == "posed" || word == "elicited" || word == "begins" || word == "early") {
    return Fail(Errc::kBadValue, "'" + word + "' is a word of the table, another name expected");
  }
  const auto found = state().expressions.find(word);
  if (found != state().expressions.end() && found->second.patterns.size() >= 100) {
    return Fail(Errc::kLimit, "an expression has at most 100 patterns");
  }
  history_.Change(Part::kExpressions, "add a pattern of " + word, "", [&](State& state) {
    auto& patterns = state.expressions[word].patterns;
    patterns.push_back(patterns.empty() ? fsm::FaceLook{} : patterns.back());
  });
  return {};
}

vm::Result<void> Editor::RemovePattern(std::string_view name, int pattern) {
  if (auto fits = CheckPattern(name, pattern); !fits) return fits;
  const bool last = state().expressions.find(name)->second.patterns.size() == 1;
  history_.Change(Part::kExpressions, fmt::format("remove {} {}", name, pattern), "",
                  [&](State& state) {
                    auto& patterns = *PatternsOf(state, name);
                    patterns.erase(patterns.begin() + (pattern - 1));
                    if (last) state.expressions.erase(state.expressions.find(name));
                  });
  return {};
}

vm::Result<void> Editor::SetShape(bool bilingual, const fsm::Viseme& shape,
                                  std::string_view merge) {
  if (!fsm::FindViseme(shapes(bilingual), shape.name)) {
    std::string names;
    for (const auto& other : shapes(bilingual)) names += " " + other.name;
    return Fail(Errc::kBadValue, fmt::format("there is no mouth shape '{}'; one of{} expected",
                                             shape.name.substr(0, 40), names));
  }
  // The same bounds as those of the table.
  const fsm::Table table("shape", fsm::FormatVisemeValues(shape));
  fsm::Viseme checked = shape;
  if (auto fits = fsm::ReadVisemeValues(table.rows().front().words(), 0, checked); !fits) {
    return std::unexpected(fits.error());
  }
  history_.Change(Part::kMouth, "mouth shape " + shape.name, merge, [&](State& state) {
    for (auto& other : bilingual ? state.shapes28 : state.shapes14) {
      if (other.name == shape.name) other = shape;
    }
  });
  return {};
}

}  // namespace editor
