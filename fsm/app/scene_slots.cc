#include "fsm/app/scene_slots.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/trigonometric.hpp>

#include "fsm/app/slot_words.h"
#include "fsm/image/colour_space.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr vm::Time kMaxSettling = 2000ms;  // how far a picture may be ahead

constexpr SlotWord<ViewMode> kViewModes[] = {
    {"TEXTURE", ViewMode::kTexture},
    {"TEXTURE_WITH_WIREFRAME", ViewMode::kTextureWithWireframe},
    {"WIREFRAME", ViewMode::kWireframe}};

void DeclareView(FsmCore& core) {
  core.slots.Declare({.name = "ViewMode",
                      .grammar = GrammarOf(kViewModes),
                      .initial = "TEXTURE",
                      .help = "How the face is drawn.",
                      .on_set = core.Command([&core](const vm::SetValue& value) {
                        core.scene.view_mode = *ValueOf(kViewModes, value.word(0));
                      })});
  core.slots.Declare({.name = "Simulation",
                      .grammar = "ENABLE | DISABLE",
                      .initial = "ENABLE",
                      .help = "Whether what is soft swings as the head moves, as long hair does.",
                      .on_set = core.Command([&core](const vm::SetValue& value) {
                        core.simulates = value.word(0) == "ENABLE";
                      })});
}

void DeclareCamera(FsmCore& core) {
  core.slots.Declare(
      {.name = "Camera",
       .grammar =
           "<number 0.2..10> [ <number -500..500> ] [ <number 5..90> ] [ <number -180..180> ]",
       .initial = "1 0 14 0",
       .help =
           "Where the viewer stands: distance (1 = head and shoulders fill the view), mm above the "
           "middle of the portrait (0), field of view in degrees (14; the head stays as large), "
           "degrees "
           "round the head to the viewer's right (0).",
       .on_set = core.Command([&core](const vm::SetValue& value) {
         Camera camera = core.conventions.scene.camera;
         float* const fields[] = {&camera.distance, &camera.height_mm, &camera.field_degrees,
                                  &camera.angle_degrees};
         for (std::size_t i = 0; i < value.size(); ++i) {
           *fields[i] = RealOf(value, i);
         }
         core.scene.camera = camera;
       })});
}

void DeclareLight(FsmCore& core, const std::string& name, const std::string& what,
                  DirectionalLight Scene::*lamp) {
  core.slots.Declare(
      {.name = name,
       .grammar = "<number 0..10> [ <number -180..180> <number -90..90> ] [ <word> ]",
       .initial = "1",
       .help = what +
               ": its strength (1 = as usual), where it stands (degrees to the viewer's right, "
               "degrees up; left out = as usual), and its colour, #rrggbb (left out = as usual).",
       .on_set = core.Command([&core, lamp](const vm::SetValue& value) -> vm::Result<void> {
         DirectionalLight set;
         set.strength = RealOf(value, 0);
         if (value.size() >= 3) {
           const float side = glm::radians(RealOf(value, 1));
           const float up = glm::radians(RealOf(value, 2));
           set.direction = glm::vec3(std::sin(side) * std::cos(up), std::sin(up),
                                     std::cos(side) * std::cos(up));
         }
         if (value.size() == 2 || value.size() == 4) {
           const std::string& text = value.word(value.size() - 1);
           const auto colour = ParseColour(text);
           if (!colour) {
             return vm::Fail(vm::Errc::kBadValue, "'" + text + "' is no colour; #rrggbb expected");
           }
           set.tint = SrgbToLinear(*colour);
         }
         core.scene.*lamp = set;
         return {};
       })});
}

void DeclareSaveImage(FsmCore& core) {
  core.slots.Declare(
      {.name = "SaveImage",
       .grammar = "<file>",
       .access = vm::Access::kWriteOnly,
       .help =
           "Writes a picture of the face, .png, .bmp or .rgb by the name: as it will be when the "
           "changes begun before this command have settled, at most 2 s ahead.",
       .on_set_later = core.CommandLater([&core](const vm::SetValue& value) {
         // The state is a function of time, so the face can be drawn at once as it will be after
         // its onsets, unaffected by later commands.
         const vm::Time now = core.Now();
         const vm::Time at = std::min(core.motion->SettledAt(now), now + kMaxSettling);
         auto done = core.DrawAt(at);
         if (done) done = core.files.write_image(core.view.Read(), value.word(0));
         return done;
       })});
}

}  // namespace

void DeclareSceneSlots(FsmCore& core) {
  ResetScene(core);
  DeclareView(core);
  DeclareCamera(core);
  DeclareLight(core, "Light.key", "The large lamp", &Scene::key);
  DeclareLight(core, "Light.fill", "The lamp that brightens shadows", &Scene::fill);
  DeclareLight(core, "Light.rim", "The lamp behind, for the edge of hair and shoulder",
               &Scene::rim);
  DeclareSaveImage(core);
}

void ResetScene(FsmCore& core) {
  core.scene = core.conventions.scene;
  core.simulates = true;
}

}  // namespace fsm
