// The page of the photo: what is dragged and how, and the face made of it.

#include <fmt/format.h>

#include "face_editor/app/ui.h"
#include "face_fit/side/use_side_photos.h"

namespace editor {
namespace {

void Groups(Ui& ui) {
  Heading("Drag points. Several: Shift and click, Shift and drag, or");
  float width = 0;
  const float room = ImGui::GetContentRegionAvail().x;
  for (const PointGroup& group : PointGroups()) {
    const float wide = ImGui::CalcTextSize(group.title.data()).x + 24;
    if (width > 0 && width + wide < room) {
      ImGui::SameLine();
    } else {
      width = 0;
    }
    width += wide;
    if (!Button(ui, group.title.data())) continue;
    auto& selection = ui.editor.selection;
    if (!ImGui::GetIO().KeyShift) selection.clear();
    for (const int i : group.points) {
      if (ui.editor.state().points.contains(i)) selection.insert(i);
    }
  }
}

void Build(Ui& ui) {
  Heading("Make the face of it");
  ImGui::SetNextItemWidth(130);
  Text(ui, "##name", &ui.face_name, "name");
  ImGui::SameLine();
  const bool can = ui.editor.work() && ui.editor.work()->base;
  if (Button(ui, "Build face", can, "Makes it a face that fsm --mask NAME wears")) {
    const auto place = ui.editor.BuildFace(ui.face_name, "");
    if (ui.Check(place)) {
      ui.Tell("Face made in " + *place + ": fsm --mask " + ui.face_name + " wears it");
    }
  }
  ImGui::SameLine();
  const std::size_t views = ui.editor.side_photos().size();
  const std::string label = fmt::format("From the side: {} ...###side", views);
  if (Button(ui, label.c_str(), can && views < facefit::kMaxSidePhotos,
             "Photos of the same person turned by 20 to 60 degrees: the face that is built gets "
             "their depth and their skin")) {
    Browse(ui, "A photo from the side", FileKind::kPhoto, ui.photo_path,
           {{"Add", false, [&ui](const std::string& path) {
               auto added = ui.editor.AddSidePhoto(path);
               if (added) ui.Tell(path + " is used when the face is built");
               return added;
             }}});
  }
  Mark(ui, "from the side");
  ImGui::SameLine();
  if (Button(ui, "x##sides", views > 0, "None of them")) ui.editor.RemoveSidePhotos();
  Mark(ui, "no side photos");
}

}  // namespace

fsm::FaceState PointsPage(Ui& ui) {
  Groups(ui);
  Checkbox(ui, "Both sides alike", &ui.editor.symmetric,
           "The other side of the face moves as its mirror image");
  ImGui::SameLine();
  float percent = 100 * ui.editor.reach01;
  ImGui::SetNextItemWidth(110);
  if (Slider(ui, "What is near goes along", &percent, 0, 100, "%.0f %%")) {
    ui.editor.reach01 = percent / 100;
  }
  if (Button(ui, "As found", ui.editor.work() != nullptr,
             "All points back to where they were found")) {
    ui.Check(ui.editor.ResetPoints());
  }
  ImGui::SameLine();
  Checkbox(ui, "Mesh", &ui.view.mesh);
  ImGui::SameLine();
  Checkbox(ui, "Points", &ui.view.points);
  ImGui::SameLine();
  if (Button(ui, "Fit view", ui.editor.work() != nullptr, "Zooms so that it fits"))
    ui.view.zoom = 0;
  TryIt(ui);
  Build(ui);
  FileRow(ui, Part::kPoints, "points.txt");
  return {};
}

}  // namespace editor
