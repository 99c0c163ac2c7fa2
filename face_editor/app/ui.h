#pragma once

#include <imgui.h>

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "face_editor/app/file_dialog.h"
#include "face_editor/app/stage.h"
#include "face_editor/app/window.h"
#include "face_editor/core/editor.h"
#include "face_editor/core/player.h"
#include "fsm/base/side.h"

namespace editor {

enum class Page { kPoints, kUnits, kFields, kExpressions, kMouth, kMotions, kIdentity };
struct PageName {
  Page page;
  const char* word;   ///< in scripts
  const char* title;  ///< on its tab
};
inline constexpr std::array<PageName, 7> kPages = {
    {{Page::kPoints, "points", "Photo"},
     {Page::kUnits, "units", "Units"},
     {Page::kFields, "fields", "Units' fields"},
     {Page::kExpressions, "expressions", "Expressions"},
     {Page::kMouth, "mouth", "Mouth shapes"},
     {Page::kMotions, "motions", "Movements"},
     {Page::kIdentity, "identity", "Identity"}}};

/// What an English voice makes of "Hello, my name is Galatea.", in ms.
inline constexpr const char* kHello =
    "pau 80 hh 60 ax 50 l 80 ow 220 pau 60 m 80 ay 160 n 70 ey 150 m 90 ih 60 z 80 "
    "g 60 ae 120 l 70 ax 60 t 60 iy 150 ax 160 pau 150";

/// How the photo lies in its part of the window.
struct PhotoView {
  float zoom = 0;        ///< window units for each pixel; 0 = fit the face in
  glm::vec2 centre{};    ///< pixel in the middle
  ImVec2 low{}, high{};  ///< the part of the window, set when drawn
  bool mesh = true, points = true;

  /// What the mouse is doing with the photo, from press to release.
  struct Gesture {
    enum class Kind { kNone, kPoints, kPan, kFrame } kind = Kind::kNone;
    PointMap from;
    glm::vec2 start{};  ///< in the photo
    ImVec2 pressed{};   ///< in the window
  } gesture;
  unsigned texture = 0;
  std::shared_ptr<const PhotoWork> shown;     ///< in the texture
  std::shared_ptr<const BuiltFace> lines_of;  ///< whose mesh the lines are
  std::vector<std::pair<glm::vec2, glm::vec2>> lines;

  glm::vec2 ToWindow(glm::vec2 pixel) const;
  glm::vec2 ToPhoto(ImVec2 at) const;
};

/// What the window shows beside what is edited. Everything in it outlives the frame.
struct Ui {
  Ui(Editor& e, Player& p, Stage& s, Window& w) : editor(e), player(p), stage(s), window(w) {}

  Editor& editor;
  Player& player;
  Stage& stage;
  Window& window;
  vm::Time now{0};

  Page page = Page::kPoints;
  Page tab = Page::kIdentity;  ///< the page of the frame before
  int turning = 0;             ///< frames until the tabs have followed a page turned by a script
  std::string photo_path;
  std::string message;  ///< the last thing to tell, at the bottom
  bool failed = false;
  bool closed = false;  ///< the window is to go, whatever is not saved

  int field_unit = 12;                       ///< whose rows are shown
  fsm::Sided<bool> field_sides{true, true};  ///< shown there
  float field_percent = 100;
  int field_row = 0;                 ///< the field under the mouse, 0 = none
  std::string field_word = "field";  ///< of a new row

  std::string expression = "HAPPY";
  int pattern = 1;
  bool elicited = false;
  bool bilingual = false;
  std::string shape = "a";
  std::string motion = "NOD";
  int motion_pattern = 1;
  float scrub_ms = 0;  ///< the instant of the movement that is shown
  double plot_ms = 1000;
  float plot_degrees = 10;
  std::pair<int, int> plot_key{-1, 0};  ///< the key frame and axis dragged, -1 = none
  bool linked = true;                   ///< both sides of the face
  std::array<bool, 3> regions{true, true, true};
  std::vector<int> unit_order;  ///< of the sliders
  bool loop = true;
  float distance = 1;  ///< of the viewer from the head, as of fsm::Camera
  std::string say = kHello;
  std::string face_name;              ///< of the face made of a photo
  std::string offered_name;           ///< the one its file gave
  std::string own_name = "berta";     ///< of the face made with sliders
  std::string new_name;               ///< of an expression to be made
  std::map<Part, std::string> paths;  ///< where each part is kept
  std::string folder;                 ///< of tables
  std::string tables;                 ///< the folder whose tables heads from elsewhere are made by
  FileDialog dialog;
  PhotoView view;
  fsm::Viewport preview;  ///< where the head is drawn this frame; width 0: nowhere

  /// Middles of the widgets drawn last, by their labels: what scripts click on.
  std::map<std::string, ImVec2, std::less<>> marks;

  void Tell(std::string text) {
    message = std::move(text);
    failed = false;
  }
  /// Tells the error, if it is one; true if not.
  template <typename T>
  bool Check(const vm::Result<T>& result) {
    if (result) return true;
    message = result.error().text;
    failed = true;
    return false;
  }
  void Play(const Show& show) { Check(player.Start(show, loop, now)); }
};

// Widgets that remember where they are, and end a step of undo where they are let go.
bool Button(Ui& ui, const char* label, bool enabled = true, const char* tip = nullptr);
bool Checkbox(Ui& ui, const char* label, bool* value, const char* tip = nullptr);
/// `id` names it; the label is shown at its right.
bool Slider(Ui& ui, const char* label, float* value, float low, float high,
            const char* format = "%.2f");
bool Text(Ui& ui, const char* label, std::string* value, const char* hint = "");
void Heading(const char* text);
/// One of names; true if another was chosen.
bool Choice(Ui& ui, const char* label, std::string* value, const std::vector<std::string>& names);
void Mark(Ui& ui, const char* label);

// Pages. Each draws its part of the side panel and may say what the face does (the state of the
// preview when nothing is played).
void DrawPhoto(Ui& ui);  ///< the photo with its points, in the current window
fsm::FaceState PointsPage(Ui& ui);
fsm::FaceState UnitsPage(Ui& ui);
fsm::FaceState FieldsPage(Ui& ui);
fsm::FaceState ExpressionsPage(Ui& ui);
fsm::FaceState MouthPage(Ui& ui);
fsm::FaceState MotionsPage(Ui& ui);
fsm::FaceState IdentityPage(Ui& ui);

/// Dots over the preview, in the current window: what the field under the mouse moves.
void DrawTouched(Ui& ui, ImVec2 low, ImVec2 size);

/// Sliders of the units of a look, by number or those that act before the others; true if one was
/// moved. `merge` gets the name of the change.
bool LookSliders(Ui& ui, fsm::FaceLook& look, bool used_first, std::string* merge);
/// "LipCornerPuller" as words.
std::string Spaced(const std::string& name);
/// Buttons that play expressions and speech on the preview.
void TryIt(Ui& ui);
/// Path, load and save of a part.
void FileRow(Ui& ui, Part part, const char* file, bool bilingual = false);

/// Opens a photo, or a head from elsewhere (`face`: see OpenHead), which is shown once it is made.
vm::Result<void> OpenFile(Ui& ui, const std::string& path, const std::string& face = "");
/// Takes new heads and tells what is to be known of them. Error: what the user was told.
vm::Result<void> UpdateStage(Ui& ui);
/// The whole window; gives what the face does in it.
fsm::FaceState DrawUi(Ui& ui);

}  // namespace editor
