#include <imgui.h>
#include <imgui_stdlib.h>

#include "face_editor/app/ui.h"

namespace editor {

namespace {

void MarkAt(Ui& ui, std::string_view label, ImVec2 middle) {
  // What is only an identity of ImGui's is not shown, but is a name here.
  const std::size_t hidden = label.find("##");
  ui.marks[std::string(hidden == 0 ? label.substr(2) : label.substr(0, hidden))] = middle;
}

void Tip(const char* tip) {
  if (tip && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) {
    ImGui::SetTooltip("%s", tip);
  }
}

void SealIfLeft(Ui& ui) {
  if (ImGui::IsItemDeactivated()) ui.editor.history().Seal();
}

}  // namespace

void Mark(Ui& ui, const char* label) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  MarkAt(ui, label, {0.5F * (low.x + high.x), 0.5F * (low.y + high.y)});
}

bool Button(Ui& ui, const char* label, bool enabled, const char* tip) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label);
  ImGui::EndDisabled();
  Mark(ui, label);
  Tip(tip);
  return pressed;
}

bool Checkbox(Ui& ui, const char* label, bool* value, const char* tip) {
  const bool changed = ImGui::Checkbox(label, value);
  Mark(ui, label);
  Tip(tip);
  return changed;
}

bool Slider(Ui& ui, const char* label, float* value, float low, float high, const char* format) {
  const float width = ImGui::CalcItemWidth();
  const bool changed = ImGui::SliderFloat(label, value, low, high, format);
  // Its label belongs to it, but a click on that does nothing.
  const ImVec2 at = ImGui::GetItemRectMin();
  MarkAt(ui, label, {at.x + 0.5F * width, 0.5F * (at.y + ImGui::GetItemRectMax().y)});
  SealIfLeft(ui);
  return changed;
}

bool Text(Ui& ui, const char* label, std::string* value, const char* hint) {
  const bool changed = ImGui::InputTextWithHint(label, hint, value);
  Mark(ui, label);
  SealIfLeft(ui);
  return changed;
}

void Heading(const char* text) {
  ImGui::Spacing();
  ImGui::TextDisabled("%s", text);
  ImGui::Separator();
}

bool Choice(Ui& ui, const char* label, std::string* value, const std::vector<std::string>& names) {
  bool changed = false;
  const bool open = ImGui::BeginCombo(label, value->c_str());
  Mark(ui, label);
  if (!open) return false;
  for (const std::string& name : names) {
    if (ImGui::Selectable(name.c_str(), name == *value)) {
      *value = name;
      changed = true;
    }
    Mark(ui, name.c_str());
    if (name == *value && ImGui::IsWindowAppearing()) ImGui::SetItemDefaultFocus();
  }
  ImGui::EndCombo();
  return changed;
}

void FileRow(Ui& ui, Part part, const char* file, bool bilingual) {
  Heading(ui.editor.Unsaved(part) ? "File (changed)" : "File");
  std::string& path = ui.paths[part];
  if (path.empty()) path = file;
  ImGui::PushID(file);
  const auto load = [&ui, part, bilingual](const std::string& from) {
    auto done = ui.editor.Load(part, from, bilingual);
    if (!done) return done;
    ui.paths[part] = from;
    ui.Tell("Read " + from);
    return done;
  };
  const auto save = [&ui, part, bilingual](const std::string& to) {
    auto done = ui.editor.Save(part, to, bilingual);
    if (!done) return done;
    ui.paths[part] = to;
    ui.Tell("Written " + to);
    return done;
  };
  ImGui::SetNextItemWidth(-168);
  Text(ui, "##path", &path, file);
  ImGui::SameLine();
  if (Button(ui, "...", true, "Looks for the file")) {
    Browse(ui, std::string("A file as ") + file, FileKind::kTable, path,
           {{"Load", false, load}, {"Save", true, save}});
  }
  Mark(ui, "browse file");
  ImGui::SameLine();
  if (Button(ui, "Load")) ui.Check(load(path));
  ImGui::SameLine();
  if (Button(ui, "Save")) ui.Check(save(path));
  ImGui::PopID();
}

void TryIt(Ui& ui) {
  Heading("Try it on the face");
  const auto play = [&](const char* label, const Show& show) {
    ImGui::SameLine();
    if (ImGui::GetContentRegionAvail().x < 80) ImGui::NewLine();
    if (Button(ui, label)) ui.Play(show);
  };
  const auto speech = vm::ParsePhonemes(ui.say);
  if (Button(ui, "Still", ui.player.playing(ui.now))) ui.player.Stop();
  Show talk;
  if (speech) talk.speech = *speech;
  play("Speak", talk);
  for (const auto& [name, expression] : ui.editor.state().expressions) {
    if (name == "USERDEF") continue;
    Show show;
    show.expression = name;
    play(name.c_str(), show);
  }
  Show both = talk;
  both.expression = "HAPPY";
  if (ui.editor.state().expressions.contains("HAPPY")) play("Speak happily", both);
  Checkbox(ui, "Again and again", &ui.loop);
}

}  // namespace editor
