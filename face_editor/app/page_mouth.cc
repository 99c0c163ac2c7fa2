// The page of mouth shapes: the 17 parameters of each, and speech made of them.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "face_editor/app/ui.h"

namespace editor {
namespace {

struct Parameter {
  std::size_t index;
  const char* label;
  float low, high;
};
struct Block {
  const char* title;
  std::vector<Parameter> parameters;
};
// Bounds as far as a person's mouth goes; the table allows more, which can be typed (Ctrl+click).
const std::vector<Block>& Blocks() {
  static const std::vector<Block> blocks = {
      {"Upper lip, mm up and forward",
       {{0, "outer edge up", -6, 6},
        {1, "outer edge forward", -6, 8},
        {2, "inner edge up", -6, 6},
        {3, "inner edge forward", -6, 8}}},
      {"Lower lip, mm up and forward",
       {{6, "outer edge up ", -8, 6},
        {7, "outer edge forward ", -6, 8},
        {4, "inner edge up ", -8, 6},
        {5, "inner edge forward ", -6, 8}}},
      {"Corners, mm", {{8, "outward", -8, 8}, {9, "up", -6, 6}, {10, "forward", -6, 6}}},
      {"Jaw", {{11, "opening, degrees", 0, 25}, {12, "thrust, mm", -4, 8}}},
      {"Fullness of the lips, mm",
       {{13, "upper, outer edge", -3, 3},
        {14, "upper, inner edge", -3, 3},
        {15, "lower, outer edge", -3, 3},
        {16, "lower, inner edge", -3, 3}}}};
  return blocks;
}

void Shapes(Ui& ui) {
  if (Checkbox(ui, "28 shapes of English and Japanese", &ui.bilingual)) {
    ui.shape = ui.bilingual ? "aa" : "a";
  }
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  bool first = true;
  for (const fsm::Viseme& shape : ui.editor.shapes(ui.bilingual)) {
    if (!first && ImGui::GetItemRectMax().x + 60 < right) ImGui::SameLine();
    first = false;
    const bool chosen = ui.shape == shape.name;
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, {0.2F, 0.5F, 0.85F, 1});
    if (Button(ui, shape.name.c_str())) {
      ui.shape = shape.name;
      ui.player.Stop();
    }
    if (chosen) ImGui::PopStyleColor();
  }
}

bool ShapeSliders(Ui& ui, fsm::Viseme& shape, std::string& merge) {
  bool changed = false;
  const auto slider = [&](const char* label, float& value, float low, float high) {
    ImGui::SetNextItemWidth(180);
    if (!Slider(ui, label, &value, low, high)) return;
    value = std::round(value * 100) / 100;
    merge = label;
    changed = true;
  };
  for (const Block& block : Blocks()) {
    Heading(block.title);
    for (const Parameter& p : block.parameters) {
      slider(p.label, shape.pose.mouth[p.index], p.low, p.high);
    }
  }
  Heading("Beside the lips");
  slider("seal: lips closed whatever else acts", shape.pose.seal, 0, 1);
  slider("tip of the tongue up", shape.pose.tongue, 0, 1);
  float hold = static_cast<float>(shape.hold);
  slider("hold: part of the sound it stands", hold, 0, 0.9F);
  shape.hold = std::round(static_cast<double>(hold) * 100) / 100;
  return changed;
}

}  // namespace

fsm::FaceState MouthPage(Ui& ui) {
  Shapes(ui);
  const fsm::Viseme* found = fsm::FindViseme(ui.editor.shapes(ui.bilingual), ui.shape);
  if (!found) return {};
  fsm::Viseme shape = *found;
  if (ui.stage.head()) {
    const auto m = ui.stage.head()->MeasureMouth(StateOf(shape));
    ImGui::Text("On this face: gap %.1f mm, width %.1f mm, jaw %.1f degrees",
                static_cast<double>(m.gap_mm), static_cast<double>(m.width_mm),
                static_cast<double>(m.jaw_degrees));
  }
  std::string merge;
  ImGui::BeginChild("parameters", {0, std::max(ImGui::GetContentRegionAvail().y - 215, 150.0F)});
  if (ShapeSliders(ui, shape, merge)) {
    ui.Check(ui.editor.SetShape(ui.bilingual, shape, merge));
  }
  ImGui::EndChild();
  Heading("Speech with these shapes: phonemes and ms");
  ImGui::SetNextItemWidth(-1);
  Text(ui, "##say", &ui.say, "pau 100 hh 60 ax 60 l 70 ow 240");
  if (Button(ui, "Speak")) {
    const auto speech = vm::ParsePhonemes(ui.say);
    Show talk;
    if (ui.Check(speech)) talk.speech = *speech;
    if (!talk.empty()) ui.Play(talk);
  }
  ImGui::SameLine();
  if (Button(ui, "Still", ui.player.playing(ui.now))) ui.player.Stop();
  ImGui::SameLine();
  Checkbox(ui, "Again and again", &ui.loop);
  ImGui::SameLine();
  ImGui::Text("%s", ui.player.PhonemeAt(ui.now).c_str());
  FileRow(ui, Part::kMouth, ui.bilingual ? "mouth_shapes_28.txt" : "mouth_shapes.txt",
          ui.bilingual);
  return StateOf(shape);
}

}  // namespace editor
