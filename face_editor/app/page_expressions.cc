// The page of expressions: looks by pattern, and how they come about.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "face_editor/app/ui.h"

namespace editor {
namespace {

void Patterns(Ui& ui, const fsm::Expression& expression) {
  const int count = static_cast<int>(expression.patterns.size());
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Pattern");
  for (int p = 1; p <= count; ++p) {
    ImGui::SameLine();
    const std::string label = std::to_string(p);
    if (ui.pattern == p) ImGui::PushStyleColor(ImGuiCol_Button, {0.2F, 0.5F, 0.85F, 1});
    const bool chosen = ui.pattern == p;
    if (Button(ui, label.c_str())) ui.pattern = p;
    if (chosen) ImGui::PopStyleColor();
  }
  ImGui::SameLine();
  if (Button(ui, "+", true, "Another pattern, at first like the last one") &&
      ui.Check(ui.editor.AddPattern(ui.expression))) {
    ui.pattern = count + 1;
  }
  ImGui::SameLine();
  if (Button(ui, "Remove", true, "This pattern; with its last one the expression goes too")) {
    ui.Check(ui.editor.RemovePattern(ui.expression, ui.pattern));
  }
}

void Timing(Ui& ui, const fsm::Expression& expression) {
  Heading("How it comes about, ms");
  if (ImGui::RadioButton("shown on purpose", !ui.elicited)) ui.elicited = false;
  ImGui::SameLine();
  if (ImGui::RadioButton("felt", ui.elicited)) ui.elicited = true;
  fsm::Expression::Timing timing = ui.elicited ? expression.elicited : expression.posed;
  bool changed = false;
  const auto number = [&](const char* label, double& value, float most) {
    float v = static_cast<float>(value);
    ImGui::SetNextItemWidth(150);
    if (Slider(ui, label, &v, 0, most, "%.1f")) {
      value = std::round(static_cast<double>(v) * 10) / 10;
      changed = true;
    }
  };
  number("until it stands", timing.onset_ms, 1500);
  number("eyes begin later", timing.lag_ms[0], 100);
  number("brows begin later", timing.lag_ms[1], 100);
  number("mouth begins later", timing.lag_ms[2], 100);
  if (changed) ui.Check(ui.editor.SetTiming(ui.expression, !ui.elicited, timing, "timing"));
}

}  // namespace

fsm::FaceState ExpressionsPage(Ui& ui) {
  std::vector<std::string> names;
  for (const auto& [name, expression] : ui.editor.state().expressions) names.push_back(name);
  if (!ui.editor.state().expressions.contains(ui.expression) && !names.empty()) {
    ui.expression = names.front();
  }
  ImGui::SetNextItemWidth(160);
  if (Choice(ui, "##expression", &ui.expression, names)) ui.pattern = 1;
  ImGui::SameLine();
  const auto show = [&] {
    Show what;
    what.expression = ui.expression;
    what.pattern = ui.pattern;
    what.elicited = ui.elicited;
    ui.Play(what);
  };
  if (Button(ui, "Play")) show();
  ImGui::SameLine();
  if (Button(ui, "Still", ui.player.playing(ui.now))) ui.player.Stop();
  ImGui::SameLine();
  Checkbox(ui, "Again and again", &ui.loop);
  ImGui::SetNextItemWidth(160);
  Text(ui, "##new", &ui.new_name, "a new name");
  ImGui::SameLine();
  if (Button(ui, "New expression", !ui.new_name.empty()) &&
      ui.Check(ui.editor.AddPattern(ui.new_name))) {
    ui.expression = std::exchange(ui.new_name, "");
    ui.pattern = 1;
  }
  auto found = ui.editor.state().expressions.find(ui.expression);
  if (found == ui.editor.state().expressions.end()) return {};
  Patterns(ui, found->second);
  found = ui.editor.state().expressions.find(ui.expression);
  if (found == ui.editor.state().expressions.end()) return {};
  ui.pattern = std::clamp(ui.pattern, 1, static_cast<int>(found->second.patterns.size()));
  fsm::FaceLook look = found->second.patterns[static_cast<std::size_t>(ui.pattern - 1)];
  std::string merge;
  if (LookSliders(ui, look, true, &merge)) {
    ui.Check(ui.editor.SetExpression(ui.expression, ui.pattern, look, merge));
  }
  Timing(ui, found->second);
  FileRow(ui, Part::kExpressions, "emotions.txt");
  return StateOf(look);
}

}  // namespace editor
