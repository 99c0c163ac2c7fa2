// The page of action units, and the sliders of a look, which the page of expressions has too.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "face_editor/app/ui.h"
#include "fsm/motion/base/unit_names.h"

namespace editor {
namespace {

constexpr const char* kRegionTitles[] = {"Eyes", "Brows", "Mouth and jaw"};

bool SliderRow(Ui& ui, int unit, fsm::FaceLook& look, std::string* merge) {
  const auto i = static_cast<std::size_t>(unit);
  const auto& names = ui.editor.unit_names().names;
  const auto name = names.find(unit);
  const std::string title =
      fmt::format("{:>2} {}", unit, name == names.end() ? "" : Spaced(name->second));
  bool changed = false;
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(title.c_str());
  for (const fsm::Side side : fsm::kSides) {
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1);
    float percent = 100 * look.au[side][i];
    const std::string id = fmt::format("##AU {}{}", unit, side == fsm::Side::kLeft ? 'L' : 'R');
    const bool one = Slider(ui, id.c_str(), &percent, 0, percent > 100 ? 200 : 100, "%.0f");
    if (!one) continue;
    const float value = std::round(percent) / 100;
    look.au[side][i] = value;
    const bool both = ui.linked && !ui.editor.unit_names().IsOneSided(unit);
    if (both) look.au.left[i] = look.au.right[i] = value;
    if (merge) *merge = id;
    changed = true;
  }
  return changed;
}

std::vector<int> UnitOrder(const fsm::UnitNames& names, const fsm::FaceLook& look,
                           bool used_first) {
  std::vector<int> order;
  for (const bool used : {true, false}) {
    for (const auto& [unit, name] : names.names) {
      const auto i = static_cast<std::size_t>(unit);
      const bool acts = look.au.left[i] != 0 || look.au.right[i] != 0;
      if (names.IsUnit(unit) && (used_first ? acts == used : used)) order.push_back(unit);
    }
  }
  return order;
}

bool GazeRow(Ui& ui, fsm::FaceLook& look, std::string* merge) {
  Heading("Where the eyes look, degrees");
  bool changed = false;
  for (const std::size_t axis : {0U, 1U}) {
    const char* label = axis == 0 ? "down" : "to the viewer's right";
    float angle = look.gaze.left[axis];
    ImGui::SetNextItemWidth(170);
    if (!Slider(ui, label, &angle, -30, 30, "%.0f")) continue;
    look.gaze.left[axis] = look.gaze.right[axis] = std::round(angle);
    if (merge) *merge = label;
    changed = true;
  }
  return changed;
}

}  // namespace

std::string Spaced(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool capital = c >= 'A' && c <= 'Z';
    if (capital && !text.empty()) text += ' ';
    text += capital && !text.empty() ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return text;
}

bool LookSliders(Ui& ui, fsm::FaceLook& look, bool used_first, std::string* merge) {
  Checkbox(ui, "Both sides together", &ui.linked);
  for (std::size_t r = 0; r < fsm::kRegions; ++r) {
    ImGui::SameLine();
    Checkbox(ui, kRegionTitles[r], &ui.regions[r]);
  }
  bool changed = false;
  const float room = ImGui::GetContentRegionAvail().y - (used_first ? 330.0F : 210.0F);
  if (ImGui::BeginTable("units", 3, ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg,
                        {0, std::max(room, 120.0F)})) {
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("Unit", ImGuiTableColumnFlags_WidthStretch, 1.3F);
    ImGui::TableSetupColumn("agent's right", ImGuiTableColumnFlags_WidthStretch, 1);
    ImGui::TableSetupColumn("agent's left", ImGuiTableColumnFlags_WidthStretch, 1);
    ImGui::TableHeadersRow();
    // They keep their places while one is dragged.
    if (!ImGui::IsAnyItemActive() || ui.unit_order.empty()) {
      ui.unit_order = UnitOrder(ui.editor.unit_names(), look, used_first);
    }
    for (const int unit : ui.unit_order) {
      const auto i = static_cast<std::size_t>(unit);
      if (!ui.regions[static_cast<std::size_t>(ui.editor.unit_regions().RegionOf(i))]) continue;
      if (SliderRow(ui, unit, look, merge)) changed = true;
    }
    ImGui::EndTable();
  }
  return GazeRow(ui, look, merge) || changed;
}

fsm::FaceState UnitsPage(Ui& ui) {
  fsm::FaceLook look = ui.editor.state().look;
  std::string merge;
  if (LookSliders(ui, look, false, &merge)) {
    ui.editor.SetLook(look, "units", merge);
    ui.player.Stop();
  }
  Heading("This look");
  ImGui::TextWrapped("%s", fsm::FormatLook(look, ui.editor.unit_names()).c_str());
  if (Button(ui, "Clear")) ui.editor.SetLook({}, "clear units");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(130);
  std::vector<std::string> names;
  for (const auto& [name, expression] : ui.editor.state().expressions) names.push_back(name);
  Choice(ui, "##into", &ui.expression, names);
  ImGui::SameLine();
  if (Button(ui, "Add as its pattern", true, "A new pattern of that expression looks like this") &&
      ui.Check(ui.editor.AddPattern(ui.expression))) {
    const auto found = ui.editor.state().expressions.find(ui.expression);
    ui.pattern = static_cast<int>(found->second.patterns.size());
    ui.Check(ui.editor.SetExpression(ui.expression, ui.pattern, look));
    ui.Tell(
        fmt::format("It is {} {} now; the page Expressions keeps it", ui.expression, ui.pattern));
  }
  return StateOf(ui.editor.state().look);
}

}  // namespace editor
