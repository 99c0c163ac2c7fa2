#include "face_editor/app/file_dialog.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "face_editor/app/ui.h"

namespace editor {
namespace {

/// Shows another folder; the one before stays if it cannot be read.
void Go(FileDialog& dialog, const std::string& folder) {
  auto entries = ListFiles(folder, dialog.kind, dialog.all);
  if (!entries) {
    dialog.error = entries.error().text;
    return;
  }
  dialog.folder = folder;
  dialog.entries = std::move(*entries);
  dialog.error.clear();
}

bool IsFolder(const std::string& path) {
  std::error_code code;
  return std::filesystem::is_directory(path, code);
}

/// What is chosen: a folder is gone into, unless one is to be chosen.
void Choose(FileDialog& dialog, const FileDialog::Choice& choice) {
  const std::string path = WholePath(dialog.folder, dialog.name);
  const bool folder = IsFolder(path);
  if (folder && dialog.kind != FileKind::kFolder) {
    dialog.name.clear();
    return Go(dialog, path);
  }
  std::error_code code;
  if (choice.writes && !folder && dialog.replaces != path && std::filesystem::exists(path, code)) {
    dialog.replaces = path;
    dialog.error = "'" + path + "' is there already: " + choice.label + " once more replaces it";
    return;
  }
  dialog.replaces.clear();
  const auto done = choice.run(path);
  dialog.error = done ? "" : done.error().text;
  dialog.open = !done;
}

void PathRow(Ui& ui, FileDialog& dialog) {
  if (Button(ui, "Up")) Go(dialog, WholePath(dialog.folder, ".."));
  ImGui::SameLine();
  if (Button(ui, "Home")) Go(dialog, WholePath("", "~"));
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  // The end of a long path says more than its beginning.
  std::string shown = dialog.folder;
  while (shown.size() > 8 && ImGui::CalcTextSize(shown.c_str()).x > 480) {
    shown = "..." + shown.substr(shown.starts_with("...") ? 7 : 4);
  }
  ImGui::TextUnformatted(shown.c_str());
}

void List(Ui& ui, FileDialog& dialog) {
  ImGui::BeginChild("files", {0, ImGui::GetContentRegionAvail().y - 112}, true);
  std::string into;
  for (const FileEntry& entry : dialog.entries) {
    const std::string label = entry.folder ? entry.name + "/" : entry.name;
    if (ImGui::Selectable(
            label.c_str(), dialog.name == entry.name,
            ImGuiSelectableFlags_DontClosePopups | ImGuiSelectableFlags_AllowDoubleClick)) {
      dialog.name = entry.name;
      dialog.replaces.clear();
      if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) into = entry.name;
    }
    if (ImGui::IsItemVisible()) Mark(ui, label.c_str());
    if (entry.folder) continue;
    ImGui::SameLine(560);
    ImGui::TextDisabled("%s", fmt::format("{:>7} kB", (entry.bytes + 1023) / 1024).c_str());
  }
  if (dialog.entries.empty()) ImGui::TextDisabled("Nothing of this kind lies here.");
  ImGui::EndChild();
  if (into.empty()) return;
  const std::string path = WholePath(dialog.folder, into);
  if (IsFolder(path)) {
    dialog.name.clear();
    Go(dialog, path);
  } else {
    Choose(dialog, dialog.choices.front());
  }
}

void Buttons(Ui& ui, FileDialog& dialog) {
  ImGui::SetNextItemWidth(-140);
  const bool entered =
      ImGui::InputTextWithHint("##file name", "a name in this folder, or a whole path",
                               &dialog.name, ImGuiInputTextFlags_EnterReturnsTrue);
  Mark(ui, "file name");
  ImGui::SameLine();
  if (Checkbox(ui, "All files", &dialog.all)) Go(dialog, dialog.folder);
  const bool named = !dialog.name.empty() || dialog.kind == FileKind::kFolder;
  for (const auto& choice : dialog.choices) {
    const bool first = &choice == &dialog.choices.front();
    const bool pressed = Button(ui, (choice.label + "##dialog").c_str(), named);
    if (pressed || (first && entered && named)) Choose(dialog, choice);
    ImGui::SameLine();
  }
  if (Button(ui, "Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape))) {
    dialog.open = false;
  }
  ImGui::PushTextWrapPos();
  ImGui::TextColored({1, 0.45F, 0.35F, 1}, "%s", dialog.error.c_str());
  ImGui::PopTextWrapPos();
}

}  // namespace

void Browse(Ui& ui, std::string title, FileKind kind, const std::string& path,
            std::vector<FileDialog::Choice> choices) {
  FileDialog& dialog = ui.dialog;
  dialog.title = std::move(title);
  dialog.kind = kind;
  dialog.choices = std::move(choices);
  dialog.error.clear();
  dialog.replaces.clear();
  dialog.all = false;
  const std::string whole = WholePath(dialog.folder, path.empty() ? "." : path);
  const bool folder = IsFolder(whole);
  dialog.name = folder ? "" : std::filesystem::path(whole).filename().string();
  Go(dialog, folder ? whole : WholePath(whole, ".."));
  if (!dialog.error.empty()) Go(dialog, WholePath("", "."));
  dialog.opens = true;
}

void DrawFileDialog(Ui& ui) {
  FileDialog& dialog = ui.dialog;
  const std::string id = dialog.title + "###file dialog";
  if (std::exchange(dialog.opens, false)) {
    dialog.open = true;
    ImGui::OpenPopup(id.c_str());
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5F * size.x, 0.5F * size.y}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({std::min(700.0F, size.x - 20), std::min(520.0F, size.y - 20)});
  if (!ImGui::BeginPopupModal(id.c_str(), nullptr, ImGuiWindowFlags_NoResize)) return;
  PathRow(ui, dialog);
  List(ui, dialog);
  Buttons(ui, dialog);
  if (!dialog.open) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

}  // namespace editor
