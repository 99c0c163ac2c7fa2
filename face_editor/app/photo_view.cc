// The photo with mesh and points; points are dragged here.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "face_editor/app/ui.h"

namespace editor {
namespace {

constexpr ImU32 kMeshColour = IM_COL32(120, 220, 255, 70);
constexpr ImU32 kPointColour = IM_COL32(120, 220, 255, 190);
constexpr ImU32 kNamedColour = IM_COL32(255, 210, 60, 255);
constexpr ImU32 kChosenColour = IM_COL32(255, 90, 60, 255);
constexpr ImU32 kEdgeColour = IM_COL32(0, 0, 0, 200);

ImVec2 Im(glm::vec2 p) { return {p.x, p.y}; }

using Gesture = PhotoView::Gesture;

/// The point under the mouse; named ones are preferred. -1 = none.
int PointAt(const Ui& ui, ImVec2 at) {
  int best = -1;
  float nearest = 1e9F;
  for (const auto& [i, place] : ui.editor.state().points) {
    const bool named = IsNamed(i);
    const glm::vec2 there = ui.view.ToWindow(glm::vec2(place));
    const float d = glm::distance(there, glm::vec2(at.x, at.y)) - (named ? 5.0F : 0.0F);
    if (d < 6 && d < nearest) {
      nearest = d;
      best = i;
    }
  }
  return best;
}

/// The face from forehead to chin in the middle, with some air.
void FitView(Ui& ui) {
  glm::vec2 low(1e9F), high(-1e9F);
  for (const auto& [i, at] : ui.editor.state().points) {
    low = glm::min(low, glm::vec2(at));
    high = glm::max(high, glm::vec2(at));
  }
  PhotoView& view = ui.view;
  view.centre = 0.5F * (low + high);
  const glm::vec2 size = 1.5F * glm::max(high - low, glm::vec2(20));
  view.zoom = std::min((view.high.x - view.low.x) / size.x, (view.high.y - view.low.y) / size.y);
}

void DrawMesh(Ui& ui, ImDrawList& list) {
  const auto& built = ui.stage.built();
  if (!built || !ui.view.mesh) return;
  if (ui.view.lines_of != built) ui.view.lines = MeshLines(built->made.fit.head);
  ui.view.lines_of = built;
  const ImDrawListFlags flags = list.Flags;
  list.Flags &= ~ImDrawListFlags_AntiAliasedLines;
  for (const auto& [a, b] : ui.view.lines) {
    list.AddLine(Im(ui.view.ToWindow(a)), Im(ui.view.ToWindow(b)), kMeshColour);
  }
  list.Flags = flags;
}

void DrawPoints(Ui& ui, ImDrawList& list, int under_mouse) {
  if (!ui.view.points) return;
  for (const auto& [i, place] : ui.editor.state().points) {
    const ImVec2 at = Im(ui.view.ToWindow(glm::vec2(place)));
    if (at.x < ui.view.low.x || at.y < ui.view.low.y || at.x > ui.view.high.x ||
        at.y > ui.view.high.y) {
      continue;
    }
    const bool chosen = ui.editor.selection.contains(i);
    if (IsNamed(i) || i == under_mouse) {
      list.AddCircleFilled(at, i == under_mouse ? 7.0F : 5.0F, kEdgeColour);
      list.AddCircleFilled(at, i == under_mouse ? 6.0F : 4.0F,
                           chosen ? kChosenColour : kNamedColour);
    } else {
      const float r = chosen ? 2.5F : 1.5F;
      list.AddRectFilled({at.x - r, at.y - r}, {at.x + r, at.y + r},
                         chosen ? kChosenColour : kPointColour);
    }
  }
}

void Press(Ui& ui, Gesture& gesture, int under_mouse) {
  const ImGuiIO& io = ImGui::GetIO();
  gesture.pressed = io.MousePos;
  gesture.start = ui.view.ToPhoto(io.MousePos);
  gesture.from = ui.editor.state().points;
  if (under_mouse >= 0 && ui.view.points) {
    auto& selection = ui.editor.selection;
    if (io.KeyShift) {
      selection.insert(under_mouse);
    } else if (!selection.contains(under_mouse)) {
      selection = {under_mouse};
    }
    gesture.kind = Gesture::Kind::kPoints;
  } else {
    gesture.kind = io.KeyShift ? Gesture::Kind::kFrame : Gesture::Kind::kPan;
  }
}

void Hold(Ui& ui, Gesture& gesture, ImDrawList& list) {
  const ImGuiIO& io = ImGui::GetIO();
  if (gesture.kind == Gesture::Kind::kPoints) {
    const glm::vec2 by = ui.view.ToPhoto(io.MousePos) - gesture.start;
    if (by != glm::vec2(0)) ui.editor.DragSelection(gesture.from, by, "mouse");
  } else if (gesture.kind == Gesture::Kind::kPan) {
    ui.view.centre += gesture.start - ui.view.ToPhoto(io.MousePos);
  } else {
    list.AddRect(gesture.pressed, io.MousePos, kNamedColour);
  }
}

void Release(Ui& ui, Gesture& gesture) {
  const ImGuiIO& io = ImGui::GetIO();
  const float moved =
      std::abs(io.MousePos.x - gesture.pressed.x) + std::abs(io.MousePos.y - gesture.pressed.y);
  if (gesture.kind == Gesture::Kind::kFrame) {
    const glm::vec2 a = ui.view.ToPhoto(gesture.pressed), b = ui.view.ToPhoto(io.MousePos);
    const glm::vec2 low = glm::min(a, b), high = glm::max(a, b);
    for (const auto& [i, at] : ui.editor.state().points) {
      const bool inside = at.x >= low.x && at.y >= low.y && at.x <= high.x && at.y <= high.y;
      if (inside) ui.editor.selection.insert(i);
    }
  } else if (gesture.kind == Gesture::Kind::kPan && moved < 3) {
    ui.editor.selection.clear();
  }
  ui.editor.history().Seal();
  gesture = {};
}

void Zoom(Ui& ui, float steps) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const glm::vec2 under = ui.view.ToPhoto(mouse);
  ui.view.zoom = std::clamp(ui.view.zoom * std::pow(1.15F, steps), 0.05F, 60.0F);
  ui.view.centre += under - ui.view.ToPhoto(mouse);
}

void Nudge(Ui& ui) {
  const std::pair<ImGuiKey, glm::vec2> keys[] = {{ImGuiKey_LeftArrow, {-1, 0}},
                                                 {ImGuiKey_RightArrow, {1, 0}},
                                                 {ImGuiKey_UpArrow, {0, -1}},
                                                 {ImGuiKey_DownArrow, {0, 1}}};
  for (const auto& [key, by] : keys) {
    if (!ImGui::IsKeyPressed(ImGui::GetKeyIndex(key))) continue;
    ui.editor.DragSelection(ui.editor.state().points, by, "arrows");
  }
}

}  // namespace

glm::vec2 PhotoView::ToWindow(glm::vec2 pixel) const {
  return 0.5F * glm::vec2(low.x + high.x, low.y + high.y) + zoom * (pixel - centre);
}
glm::vec2 PhotoView::ToPhoto(ImVec2 at) const {
  return centre + (glm::vec2(at.x, at.y) - 0.5F * glm::vec2(low.x + high.x, low.y + high.y)) / zoom;
}

void DrawPhoto(Ui& ui) {
  PhotoView& view = ui.view;
  view.low = ImGui::GetCursorScreenPos();
  const ImVec2 size = ImGui::GetContentRegionAvail();
  view.high = {view.low.x + size.x, view.low.y + size.y};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto& work = ui.editor.work();
  if (!work) {
    ImGui::SetCursorScreenPos({view.low.x + 0.5F * size.x - 150, view.low.y + 0.45F * size.y});
    ImGui::TextDisabled("Open a photo (above), or drop one here.");
    return;
  }
  if (view.shown != work) {
    view.texture = ui.window.Upload(view.texture, work->front.photo.image);
    view.shown = work;
    view.zoom = 0;
  }
  if (view.zoom <= 0) FitView(ui);
  list.PushClipRect(view.low, view.high, true);
  list.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(view.texture)),
                Im(view.ToWindow({0, 0})),
                Im(view.ToWindow({work->front.photo.image.width, work->front.photo.image.height})));
  ImGui::InvisibleButton("photo", size);
  Gesture& gesture = view.gesture;
  const bool over = ImGui::IsItemHovered() || gesture.kind != Gesture::Kind::kNone;
  const ImGuiIO& io = ImGui::GetIO();
  const int under = over ? PointAt(ui, io.MousePos) : -1;
  DrawMesh(ui, list);
  DrawPoints(ui, list, gesture.kind == Gesture::Kind::kNone ? under : -1);
  if (ImGui::IsItemActivated()) Press(ui, gesture, under);
  if (gesture.kind != Gesture::Kind::kNone && ImGui::IsItemActive()) Hold(ui, gesture, list);
  if (ImGui::IsItemDeactivated()) Release(ui, gesture);
  if (over && io.MouseWheel != 0) Zoom(ui, io.MouseWheel);
  if (!io.WantTextInput && !ui.editor.selection.empty()) Nudge(ui);
  if (under >= 0 && gesture.kind == Gesture::Kind::kNone) {
    ImGui::SetTooltip("%s", PointName(under).c_str());
  }
  list.PopClipRect();
}

}  // namespace editor
