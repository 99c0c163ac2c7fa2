// The page of identity: a built-in face made into somebody else by sliders.

#include <algorithm>
#include <cmath>

#include "face_editor/app/ui.h"
#include "face_editor/core/identity_head.h"
#include "fsm/head/make_head.h"

namespace editor {
namespace {

std::string Words(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

void SliderList(Ui& ui) {
  static const std::vector<std::string> names = SliderNames();
  ImGui::BeginChild("sliders", {0, std::max(ImGui::GetContentRegionAvail().y - 205, 150.0F)});
  for (const std::string& name : names) {
    const auto& sliders = ui.editor.state().sliders;
    const auto found = sliders.find(name);
    float value = found == sliders.end() ? 0 : found->second;
    ImGui::SetNextItemWidth(220);
    if (Slider(ui, Words(name).c_str(), &value, -3, 3)) {
      ui.Check(ui.editor.SetSlider(name, std::round(value * 100) / 100, name));
    }
  }
  ImGui::EndChild();
}

}  // namespace

fsm::FaceState IdentityPage(Ui& ui) {
  std::string base = ui.editor.state().base;
  ImGui::SetNextItemWidth(160);
  if (Choice(ui, "made into somebody else", &base, fsm::Identities()))
    ui.Check(ui.editor.SetBase(base));
  Heading("0 = as the plain head; numbers are typed with Ctrl and a click");
  SliderList(ui);
  TryIt(ui);
  Heading(ui.editor.Unsaved(Part::kIdentity) ? "Its name (changed)" : "Its name");
  ImGui::SetNextItemWidth(160);
  Text(ui, "##own", &ui.own_name, "name");
  ImGui::SameLine();
  if (Button(ui, "Load", !ui.own_name.empty()) &&
      ui.Check(ui.editor.LoadIdentity(ui.own_name, ""))) {
    ui.Tell("Read the face " + ui.own_name);
  }
  ImGui::SameLine();
  if (Button(ui, "Save", !ui.own_name.empty(), "A face that fsm --mask NAME wears")) {
    const auto place = ui.editor.SaveIdentity(ui.own_name, "");
    if (ui.Check(place)) {
      ui.Tell("Written to " + *place + ": fsm --mask " + ui.own_name + " wears it");
    }
  }
  return {};
}

}  // namespace editor
