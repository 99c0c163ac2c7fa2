// The page of movements of the head: key frames as a table and as curves to drag.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "face_editor/app/ui.h"

namespace editor {
namespace {

constexpr ImU32 kAxisColours[] = {IM_COL32(255, 120, 90, 255), IM_COL32(110, 220, 120, 255),
                                  IM_COL32(110, 170, 255, 255)};
constexpr const char* kAxisNames[] = {"down", "to the right", "tilt"};

struct Plot {
  ImVec2 low, high;
  double ms;      ///< at the right edge
  float degrees;  ///< at the upper edge; as many below
  ImVec2 At(double t, float angle) const {
    return {low.x + static_cast<float>(t / ms) * (high.x - low.x),
            0.5F * (low.y + high.y) - angle / degrees * 0.5F * (high.y - low.y)};
  }
  double Ms(float x) const { return static_cast<double>((x - low.x) / (high.x - low.x)) * ms; }
  float Degrees(float y) const {
    return (0.5F * (low.y + high.y) - y) / (0.5F * (high.y - low.y)) * degrees;
  }
};

void DrawCurves(const Plot& plot, const fsm::HeadCurve& curve, double cursor_ms) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(plot.low, plot.high, IM_COL32(25, 27, 29, 255));
  list.AddLine(plot.At(0, 0), plot.At(plot.ms, 0), IM_COL32(120, 120, 120, 255));
  list.AddText({plot.low.x + 4, plot.low.y + 2}, IM_COL32(160, 160, 160, 255),
               fmt::format("{:.0f} degrees, {:.0f} ms", plot.degrees, plot.ms).c_str());
  constexpr int kSteps = 120;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<ImVec2> line;
    for (int i = 0; i <= kSteps; ++i) {
      const double t = plot.ms * i / kSteps;
      line.push_back(plot.At(t, curve.At(t)[axis]));
    }
    list.AddPolyline(line.data(), static_cast<int>(line.size()), kAxisColours[axis], 0, 2);
    for (const auto& key : curve.keys()) {
      list.AddCircleFilled(plot.At(key.ms, key.angles[axis]), 4, kAxisColours[axis]);
    }
  }
  if (cursor_ms >= 0 && cursor_ms <= plot.ms) {
    list.AddLine({plot.At(cursor_ms, 0).x, plot.low.y}, {plot.At(cursor_ms, 0).x, plot.high.y},
                 IM_COL32(255, 255, 255, 160));
  }
}

/// A key frame's angle under the mouse: which frame and axis; -1 if none.
std::pair<int, int> KeyAt(const Plot& plot, const Editor::Keys& keys, ImVec2 at) {
  std::pair<int, int> found{-1, 0};
  float nearest = 100;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const ImVec2 p = plot.At(keys[i].ms, keys[i].angles[axis]);
      const float d = (p.x - at.x) * (p.x - at.x) + (p.y - at.y) * (p.y - at.y);
      if (d >= nearest) continue;
      nearest = d;
      found = {static_cast<int>(i), static_cast<int>(axis)};
    }
  }
  return found;
}

/// The curves; true if a key frame was dragged.
bool Curves(Ui& ui, const fsm::HeadCurve& curve, Editor::Keys& keys) {
  Plot plot{ImGui::GetCursorScreenPos(), {}, ui.plot_ms, ui.plot_degrees};
  plot.high = {plot.low.x + ImGui::GetContentRegionAvail().x, plot.low.y + 190};
  if (ui.plot_key.first < 0) {
    // The scale stays as it is while a key frame is dragged.
    float most = 6;
    for (const auto& key : keys) {
      for (const float angle : key.angles) most = std::max(most, std::abs(angle));
    }
    plot.ms = ui.plot_ms = 1.1 * curve.length_ms();
    plot.degrees = ui.plot_degrees = 1.25F * most;
  }
  DrawCurves(plot, curve, ui.player.playing(ui.now) ? -1 : static_cast<double>(ui.scrub_ms));
  ImGui::InvisibleButton("curves", {plot.high.x - plot.low.x, plot.high.y - plot.low.y});
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ui.marks[fmt::format("key {} {}", i + 1, axis + 1)] =
          plot.At(keys[i].ms, keys[i].angles[axis]);
    }
  }
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  if (ImGui::IsItemActivated()) ui.plot_key = KeyAt(plot, keys, mouse);
  if (ImGui::IsItemDeactivated()) {
    ui.plot_key = {-1, 0};
    ui.editor.history().Seal();
  }
  if (!ImGui::IsItemActive()) return false;
  if (ui.plot_key.first < 0 || ui.plot_key.first >= static_cast<int>(keys.size())) {
    ui.scrub_ms = static_cast<float>(std::clamp(plot.Ms(mouse.x), 0.0, plot.ms));
    ui.player.Stop();
    return false;
  }
  const auto i = static_cast<std::size_t>(ui.plot_key.first);
  const double after = i == 0 ? 1 : keys[i - 1].ms + 1;
  const double before = i + 1 < keys.size() ? keys[i + 1].ms - 1 : 86400000;
  const double ms = std::clamp(std::round(plot.Ms(mouse.x)), after, std::max(after, before));
  const float angle = std::clamp(std::round(plot.Degrees(mouse.y) * 10) / 10, -90.0F, 90.0F);
  float& value = keys[i].angles[static_cast<std::size_t>(ui.plot_key.second)];
  const bool changed = ms != keys[i].ms || angle != value;
  keys[i].ms = ms;
  value = angle;
  return changed;
}

/// The key frames as a table; true if one was changed, added or removed.
bool Table(Ui& ui, Editor::Keys& keys) {
  bool changed = false;
  if (!ImGui::BeginTable("keys", 5, ImGuiTableFlags_RowBg)) return false;
  ImGui::TableSetupColumn("ms");
  for (const char* name : kAxisNames) ImGui::TableSetupColumn(name);
  ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed, 30);
  ImGui::TableHeadersRow();
  std::size_t removed = keys.size();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-1);
    changed |= ImGui::InputDouble("##ms", &keys[i].ms, 0, 0, "%.0f");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ImGui::TableNextColumn();
      ImGui::SetNextItemWidth(-1);
      ImGui::PushID(static_cast<int>(axis));
      changed |= ImGui::InputFloat("##angle", &keys[i].angles[axis], 0, 0, "%.1f");
      ImGui::PopID();
    }
    ImGui::TableNextColumn();
    if (ImGui::SmallButton("x") && keys.size() > 1) removed = i;
    ImGui::PopID();
  }
  ImGui::EndTable();
  if (removed < keys.size()) {
    keys.erase(keys.begin() + static_cast<std::ptrdiff_t>(removed));
    changed = true;
  }
  if (Button(ui, "Another key frame")) {
    keys.push_back({keys.back().ms + 200, {0, 0, 0}});
    changed = true;
  }
  return changed;
}

}  // namespace

fsm::FaceState MotionsPage(Ui& ui) {
  std::vector<std::string> kinds;
  for (const auto& [kind, curves] : ui.editor.state().curves) kinds.push_back(kind);
  ImGui::SetNextItemWidth(140);
  if (Choice(ui, "##kind", &ui.motion, kinds)) ui.motion_pattern = 1;
  const std::size_t count = ui.editor.state().curves.find(ui.motion)->second.size();
  ui.motion_pattern = std::clamp(ui.motion_pattern, 1, std::max(1, static_cast<int>(count)));
  for (int p = 1; p <= static_cast<int>(count); ++p) {
    ImGui::SameLine();
    const bool chosen = ui.motion_pattern == p;
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, {0.2F, 0.5F, 0.85F, 1});
    if (Button(ui, std::to_string(p).c_str())) ui.motion_pattern = p;
    if (chosen) ImGui::PopStyleColor();
  }
  ImGui::SameLine();
  if (Button(ui, "+", true, "Another pattern, at first like the last one") &&
      ui.Check(ui.editor.AddCurve(ui.motion))) {
    ui.motion_pattern = static_cast<int>(count) + 1;
  }
  ImGui::SameLine();
  if (Button(ui, "Remove", count > 0))
    ui.Check(ui.editor.RemoveCurve(ui.motion, ui.motion_pattern));
  const auto& curves = ui.editor.state().curves.find(ui.motion)->second;
  if (curves.empty() || ui.motion_pattern > static_cast<int>(curves.size())) return {};

  Show show;
  show.motion = ui.motion;
  show.motion_pattern = ui.motion_pattern;
  if (Button(ui, "Play")) ui.Play(show);
  ImGui::SameLine();
  if (Button(ui, "Still", ui.player.playing(ui.now))) ui.player.Stop();
  ImGui::SameLine();
  Checkbox(ui, "Again and again", &ui.loop);
  ImGui::TextWrapped("Drag the dots; elsewhere in the picture the head is shown at that time.");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kAxisColours[axis]), "%s", kAxisNames[axis]);
  }
  const fsm::HeadCurve curve = curves[static_cast<std::size_t>(ui.motion_pattern - 1)];
  Editor::Keys keys(curve.keys().begin(), curve.keys().end());
  const bool dragged = Curves(ui, curve, keys);
  const bool typed = Table(ui, keys);
  if (dragged || typed) {
    ui.Check(ui.editor.SetCurve(ui.motion, ui.motion_pattern, keys, dragged ? "curve" : ""));
  }
  FileRow(ui, Part::kMotions, "motions.txt");
  fsm::FaceState state;
  state.head_rotation = curve.At(static_cast<double>(ui.scrub_ms));
  return state;
}

}  // namespace editor
