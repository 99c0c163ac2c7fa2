#include "face_editor/app/ui.h"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "face_editor/app/given_head.h"
#include "face_editor/core/face_name.h"

namespace editor {
namespace {

constexpr float kPanelWidth = 470, kTopHeight = 78, kBottomHeight = 32, kPhotoPreview = 0.4F;
constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings |
                                    ImGuiWindowFlags_NoBringToFrontOnFocus;

vm::Result<void> LoadFolder(Ui& ui, const std::string& folder) {
  auto done = ui.editor.LoadTables(folder);
  if (!done) return done;
  ui.folder = ui.tables = folder;
  ui.Tell("Read the tables in " + folder);
  return {};
}

vm::Result<void> SaveFolder(Ui& ui, const std::string& folder) {
  const auto count = ui.editor.SaveTables(folder);
  if (!count) return std::unexpected(count.error());
  ui.folder = folder;
  ui.Tell(fmt::format("{} tables written to {}", *count, folder));
  return {};
}

void Shortcuts(Ui& ui) {
  const auto pressed = ui.window.TakeShortcuts();
  if (ImGui::GetIO().WantTextInput) return;
  for (const Window::Shortcut& shortcut : pressed) {
    if (shortcut.key == 'z' && !shortcut.shift) ui.editor.history().Undo();
    if (shortcut.key == 'y' || (shortcut.key == 'z' && shortcut.shift)) ui.editor.history().Redo();
  }
}

void TopBar(Ui& ui, ImVec2 size) {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({size.x, kTopHeight});
  ImGui::Begin("top", nullptr, kFixed);
  ImGui::SetNextItemWidth(std::max(size.x - 690, 150.0F));
  const bool entered = ImGui::InputTextWithHint(
      "##photo", "a photo, or a head: .obj .glb .gltf .vrm, or an original's config.txt",
      &ui.photo_path, ImGuiInputTextFlags_EnterReturnsTrue);
  Mark(ui, "photo path");
  ImGui::SameLine();
  if (Button(ui, "...##photo", true, "Looks for a photo or a head")) {
    Browse(ui, "A photo or a head", FileKind::kPhotoOrHead, ui.photo_path,
           {{"Open", false, [&ui](const std::string& path) { return OpenFile(ui, path); }}});
  }
  Mark(ui, "browse photo");
  ImGui::SameLine();
  if (Button(ui, "Open", !ui.photo_path.empty()) || entered) {
    ui.Check(OpenFile(ui, ui.photo_path));
  }
  ImGui::SameLine();
  const History& history = ui.editor.history();
  const std::string undo = "Takes back: " + std::string(history.undo_name());
  const std::string redo = "Again: " + std::string(history.redo_name());
  if (Button(ui, "Undo", history.can_undo(), undo.c_str())) ui.editor.history().Undo();
  ImGui::SameLine();
  if (Button(ui, "Redo", history.can_redo(), redo.c_str())) ui.editor.history().Redo();
  ImGui::SameLine();
  ImGui::SetNextItemWidth(130);
  Text(ui, "##folder", &ui.folder, "folder of tables");
  ImGui::SameLine();
  if (Button(ui, "...##folder", true, "Looks for a folder of tables")) {
    Browse(ui, "A folder of tables", FileKind::kFolder, ui.folder,
           {{"Load all", false, [&ui](const std::string& path) { return LoadFolder(ui, path); }},
            {"Save all", false, [&ui](const std::string& path) { return SaveFolder(ui, path); }}});
  }
  Mark(ui, "browse folder");
  ImGui::SameLine();
  if (Button(ui, "Load all", !ui.folder.empty(), "Reads all tables found in the folder")) {
    ui.Check(LoadFolder(ui, ui.folder));
  }
  ImGui::SameLine();
  if (Button(ui, "Save all", !ui.folder.empty(),
             "Writes all tables that were changed; fsm --tables FOLDER uses them")) {
    ui.Check(SaveFolder(ui, ui.folder));
  }
  // A page may also be turned by a script.
  if (ui.page != ui.tab) ui.turning = 3;
  if (ImGui::BeginTabBar("pages")) {
    for (const PageName& page : kPages) {
      const bool turn = ui.turning > 0 && ui.page == page.page;
      if (ImGui::BeginTabItem(page.title, nullptr,
                              turn ? ImGuiTabItemFlags_SetSelected : ImGuiTabItemFlags_None)) {
        if (ui.turning == 0 && ui.page != page.page) {
          ui.page = page.page;
          ui.player.Stop();
        }
        ImGui::EndTabItem();
      }
      Mark(ui, page.title);
    }
    ImGui::EndTabBar();
  }
  ui.tab = ui.page;
  ui.turning = std::max(ui.turning - 1, 0);
  ImGui::End();
}

void BottomBar(Ui& ui, ImVec2 size) {
  ImGui::SetNextWindowPos({0, size.y - kBottomHeight});
  ImGui::SetNextWindowSize({size.x, kBottomHeight});
  ImGui::Begin("bottom", nullptr, kFixed);
  if (ui.stage.busy()) {
    ImGui::TextUnformatted("making the face ...");
    ImGui::SameLine();
  }
  const ImVec4 red{1, 0.45F, 0.35F, 1};
  const ImVec4 grey{0.8F, 0.82F, 0.84F, 1};
  ImGui::TextColored(ui.failed ? red : grey, "%s", ui.message.c_str());
  ImGui::End();
}

/// The hole through which the head is seen; it is turned with the mouse.
void Preview(Ui& ui, ImVec2 low, ImVec2 size) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("preview", nullptr, kFixed | ImGuiWindowFlags_NoBackground);
  if (!ui.stage.head()) ImGui::TextDisabled("The face is being made ...");
  if (ui.page == Page::kFields) DrawTouched(ui, low, size);
  ImGui::SetCursorPos({0, 0});
  ImGui::InvisibleButton("turn", {size.x, std::max(size.y - 40, 10.0F)});
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemActive()) {
    ui.stage.turn[1] = std::clamp(ui.stage.turn[1] + 0.4F * io.MouseDelta.x, -180.0F, 180.0F);
    ui.stage.turn[0] = std::clamp(ui.stage.turn[0] + 0.4F * io.MouseDelta.y, -60.0F, 60.0F);
  }
  float& distance = ui.distance;
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    distance = std::clamp(distance * std::pow(0.9F, io.MouseWheel), 0.25F, 3.0F);
  }
  ImGui::SetCursorPos({10, size.y - 34});
  if (Button(ui, "From the front", ui.stage.turn != std::array<float, 2>{} || distance != 1)) {
    ui.stage.turn = {};
    distance = 1;
  }
  ImGui::SameLine();
  bool lines = ui.stage.scene.view_mode == fsm::ViewMode::kTextureWithWireframe;
  if (Checkbox(ui, "Lines", &lines)) {
    ui.stage.scene.view_mode =
        lines ? fsm::ViewMode::kTextureWithWireframe : fsm::ViewMode::kTexture;
  }
  ImGui::End();
  // Beside a photo there is only room for the head.
  const bool near = ui.page == Page::kPoints;
  ui.stage.scene.camera.distance = distance * (near ? 0.68F : 1.0F);
  ui.stage.scene.camera.height_mm = near ? 28.0F : 0.0F;
  const float scale = ui.window.scale();
  const auto pixels = [scale](float v) { return static_cast<int>(std::lround(scale * v)); };
  ui.preview = {pixels(low.x), pixels(low.y), pixels(size.x), pixels(size.y)};
}

/// Closing the window is held up while something is not saved.
void AskBeforeLeaving(Ui& ui) {
  constexpr const char* kTitle = "Not saved";
  if (ui.window.close_requested() && !ui.editor.UnsavedNames().empty()) {
    ui.window.RequestClose(false);
    ImGui::OpenPopup(kTitle);
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
  if (!ImGui::BeginPopupModal(kTitle, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return;
  ImGui::Text("Changed and not saved: %s", ui.editor.UnsavedNames().c_str());
  ImGui::Spacing();
  if (Button(ui, "Close without saving")) ui.closed = true;
  ImGui::SameLine();
  if (Button(ui, "Go on editing")) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

fsm::FaceState PageOf(Ui& ui) {
  switch (ui.page) {
    case Page::kPoints:
      return PointsPage(ui);
    case Page::kUnits:
      return UnitsPage(ui);
    case Page::kFields:
      return FieldsPage(ui);
    case Page::kExpressions:
      return ExpressionsPage(ui);
    case Page::kMouth:
      return MouthPage(ui);
    case Page::kMotions:
      return MotionsPage(ui);
    case Page::kIdentity:
      return IdentityPage(ui);
  }
  return {};
}

}  // namespace

vm::Result<void> OpenFile(Ui& ui, const std::string& path, const std::string& face) {
  if (IsHeadFile(path)) {
    ui.photo_path = path;
    ui.Tell("Opening " + path + " ...");
    ui.stage.Open([path, face, tables = ui.tables] { return OpenHead(path, face, tables); });
    if (ui.page == Page::kPoints || ui.page == Page::kIdentity) ui.page = Page::kExpressions;
    return {};
  }
  auto opened = ui.editor.OpenPhoto(path);
  if (!opened) return opened;
  ui.photo_path = path;
  ui.page = Page::kPoints;
  // A name that somebody has typed stays.
  const std::string offered = std::exchange(ui.offered_name, FaceNameOf(path));
  if (ui.face_name == offered) ui.face_name = ui.offered_name;
  const auto& work = ui.editor.work();
  ui.Tell(!work->notice.empty() ? work->notice
          : work->front.photo.face_count > 1
              ? fmt::format("{} faces; the largest was taken", work->front.photo.face_count)
              : "Opened " + path + ": drag points where they miss, then build the face");
  return {};
}

vm::Result<void> UpdateStage(Ui& ui) {
  using Wanted = Stage::Wanted;
  const Wanted wanted = ui.page == Page::kIdentity ? Wanted::kIdentity
                        : ui.page == Page::kPoints ? Wanted::kPhoto
                                                   : Wanted::kLast;
  auto updated = ui.stage.Update(ui.editor, wanted);
  ui.Check(updated);
  if (!ui.stage.notice.empty()) ui.Tell(std::exchange(ui.stage.notice, ""));
  return updated;
}

fsm::FaceState DrawUi(Ui& ui) {
  ui.marks.clear();
  Shortcuts(ui);
  if (!ui.window.dropped.empty()) {
    ui.Check(OpenFile(ui, std::exchange(ui.window.dropped, "")));
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  TopBar(ui, size);
  BottomBar(ui, size);
  const float height = std::max(size.y - kTopHeight - kBottomHeight, 50.0F);
  const float left = std::max(size.x - kPanelWidth, 100.0F);
  float panel_top = kTopHeight;
  if (ui.page == Page::kPoints) {
    ImGui::SetNextWindowPos({0, kTopHeight});
    ImGui::SetNextWindowSize({left, height});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::Begin("photo page", nullptr, kFixed | ImGuiWindowFlags_NoScrollWithMouse);
    DrawPhoto(ui);
    ImGui::End();
    ImGui::PopStyleVar();
    Preview(ui, {left, kTopHeight}, {kPanelWidth, kPhotoPreview * height});
    panel_top += kPhotoPreview * height;
  } else {
    Preview(ui, {0, kTopHeight}, {left, height});
  }
  ImGui::SetNextWindowPos({left, panel_top});
  ImGui::SetNextWindowSize({kPanelWidth, size.y - kBottomHeight - panel_top});
  ImGui::Begin("panel", nullptr, kFixed & ~ImGuiWindowFlags_NoScrollbar);
  const fsm::FaceState still = PageOf(ui);
  ImGui::End();
  DrawFileDialog(ui);
  AskBeforeLeaving(ui);
  return ui.player.At(ui.now).value_or(still);
}

}  // namespace editor
