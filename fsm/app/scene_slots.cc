#include "fsm/app/scene_slots.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <optional>

#include "fsm/app/slot_words.h"
#include "fsm/image/colour_space.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

using namespace std::chrono_literals;

constexpr const char* kPlain = "plain";              // the background without a picture
constexpr const char* kStudio = "studio";            // a wall, brighter behind the head
constexpr const char* kTransparent = "transparent";  // no background
constexpr vm::Time kLongestSettling = 2000ms;        // how far a picture may be ahead

constexpr SlotWord<ViewMode> kViewModes[] = {
    {"TEXTURE", ViewMode::kTexture},
    {"TEXTURE_WITH_WIREFRAME", ViewMode::kTextureWithWireframe},
    {"WIREFRAME", ViewMode::kWireframe}};

std::optional<glm::vec3> ParseColour(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  unsigned rgb = 0;
  const auto [end, error] = std::from_chars(text.data() + 1, text.data() + 7, rgb, 16);
  if (error != std::errc{} || end != text.data() + 7) return std::nullopt;
  return glm::vec3(static_cast<float>(rgb >> 16 & 255u), static_cast<float>(rgb >> 8 & 255u),
                   static_cast<float>(rgb & 255u)) /
         255.0f;
}

glm::vec3 LinearColour(const glm::vec3& srgb) {
  return {SrgbToLinear(srgb.r), SrgbToLinear(srgb.g), SrgbToLinear(srgb.b)};
}

bool IsPictureName(const std::string& name) {
  const std::string lower = vm::LowerCase(name);
  return lower.ends_with(".png") || lower.ends_with(".bmp") || lower.ends_with(".rgb");
}

}  // namespace

SceneSlots::SceneSlots(FsmCore& core, std::vector<std::pair<std::string, std::string>> backgrounds,
                       const std::string& first)
    : core_(core),
      backgrounds_(std::move(backgrounds)),
      first_(!first.empty()         ? first
             : backgrounds_.empty() ? kPlain
                                    : backgrounds_.front().first),
      start_width_(core_.view.width()),
      start_height_(core_.view.height()) {
  core_.scene = FirstScene();
  DeclareBackgrounds();
  DeclareView();
  DeclareCamera();
  DeclareLight("Light.key", "The large lamp", &Scene::key);
  DeclareLight("Light.fill", "The lamp that brightens shadows", &Scene::fill);
  DeclareLight("Light.rim", "The lamp behind, for the edge of hair and shoulder", &Scene::rim);
  DeclareSaveImage();
  if (auto set = SetBackground(first_); !set) {
    if (!first.empty()) vm::OrThrow(set);
    // A missing picture of the configuration is not an error.
    core_.log("notice: background " + first_ + ": " + set.error().text +
              "; the plain one is shown");
    StorePlain();
  }
}

Scene SceneSlots::FirstScene() const {
  Scene scene;
  scene.camera.moves_by_half_views = core_.original;
  if (core_.original) {
    scene.wire = glm::vec3(1);
    scene.wire_on_black = true;
  }
  return scene;
}

void SceneSlots::DeclareBackgrounds() {
  std::string names =
      core_.original && !backgrounds_.empty() ? "" : std::string(kPlain) + "," + kStudio;
  for (const auto& [name, file] : backgrounds_) names += (names.empty() ? "" : ",") + name;
  core_.slots.Declare({.name = "BackgroundSet",
                       .grammar = "<text>",
                       .access = vm::Access::kReadOnly,
                       .initial = names,
                       .help = "The backgrounds that have names, with commas between them.",
                       .quoted = true});
  core_.slots.Declare({.name = "NowBackground",
                       .grammar = "<text>",
                       .access = vm::Access::kReadOnly,
                       .initial = first_,
                       .help = "The background shown now.",
                       .quoted = true});
  core_.slots.Declare(
      {.name = "Background",
       .grammar = "<file>",
       .initial = first_,
       .help = "What is behind the agent: a name of BackgroundSet, a picture (.png .bmp .rgb), a "
               "colour, #rrggbb, or transparent: pictures then have an alpha channel, 0 there.",
       .on_set = core_.Command([this](const vm::SetValue& value) -> vm::Result<void> {
         if (auto set = SetBackground(value.word(0)); !set) return set;
         core_.slots.Report("NowBackground", value.word(0));
         return {};
       })});
}

vm::Result<void> SceneSlots::SetBackground(const std::string& name) {
  const auto show_colour = [this](glm::vec3 colour, bool studio = false) {
    core_.scene.background = colour;
    core_.scene.studio = studio;
    core_.scene.background_image = nullptr;
    ShowBackground(false);
    return vm::Result<void>{};
  };
  if (name == kTransparent) {
    ShowBackground(true);
    return {};
  }
  if (name == kPlain) return show_colour(Scene{}.background);
  if (name == kStudio) return show_colour(Scene{}.background, true);
  if (const auto colour = ParseColour(name)) return show_colour(*colour);
  const auto named =
      std::ranges::find(backgrounds_, name, &std::pair<std::string, std::string>::first);
  if (named == backgrounds_.end() && !IsPictureName(name)) {
    return vm::Fail(vm::Errc::kBadValue,
                    "there is no background '" + name + "'; " + core_.slots.Value("BackgroundSet") +
                        ", transparent, a .png, .bmp or .rgb file or #rrggbb expected");
  }
  auto picture = core_.files.read_picture(named == backgrounds_.end() ? name : named->second);
  if (!picture) return std::unexpected(picture.error());
  core_.scene.background_image = std::make_shared<const Image>(std::move(*picture));
  ShowBackground(false);
  return {};
}

void SceneSlots::StorePlain() {
  for (const char* slot : {"Background", "NowBackground"}) core_.slots.Store(slot, kPlain);
}

void SceneSlots::ShowBackground(bool transparent) {
  transparent_ = transparent;
  core_.scene.show_background = background_enabled_ && !transparent_;
}

void SceneSlots::DeclareView() {
  core_.slots.Declare({.name = "ViewMode",
                       .grammar = GrammarOf(kViewModes),
                       .initial = "TEXTURE",
                       .help = "How the face is drawn.",
                       .on_set = core_.Command([this](const vm::SetValue& value) {
                         core_.scene.view_mode = *ValueOf(kViewModes, value.word(0));
                       })});
  core_.slots.Declare(
      {.name = "ViewBackground",
       .grammar = "ENABLE | DISABLE",
       .initial = "ENABLE",
       .help = "Whether the background is drawn; without it pictures are transparent there.",
       .on_set = core_.Command([this](const vm::SetValue& value) {
         background_enabled_ = value.word(0) == "ENABLE";
         ShowBackground(transparent_);
       })});
  core_.slots.Declare({.name = "Simulation",
                       .grammar = "ENABLE | DISABLE",
                       .initial = "ENABLE",
                       .help = "Whether what is soft swings as the head moves, as long hair does.",
                       .on_set = core_.Command([this](const vm::SetValue& value) {
                         core_.simulates = value.word(0) == "ENABLE";
                       })});
  core_.slots.Declare(
      {.name = "Window",
       .grammar = "FULLSCREEN | WINDOWED | <int 16..8192> <int 16..8192>",
       .initial = std::to_string(start_width_) + " " + std::to_string(start_height_),
       .help =
           "Width and height of the view in pixels; or the window fills the screen, or no more.",
       .on_set = core_.Command([this](const vm::SetValue& value) -> vm::Result<void> {
         if (std::ranges::any_of(core_.parts, [](const auto& part) { return part->LocksSize(); })) {
           return vm::Fail(vm::Errc::kBusy,
                           "a film of this size is recorded; set Record = STOP first");
         }
         if (value.size() == 1) return FillScreen(value.word(0) == "FULLSCREEN");
         return core_.view.Resize(static_cast<int>(value.number(0)),
                                  static_cast<int>(value.number(1)));
       })});
}

void SceneSlots::DeclareCamera() {
  core_.slots.Declare(
      {.name = "Camera",
       .grammar =
           "<number 0.2..10> [ <number -500..500> ] [ <number 5..90> ] [ <number -180..180> ]",
       .initial = "1 0 25 0",
       .help =
           "Where the viewer stands: distance (1 = head and shoulders fill the view), mm above the "
           "middle of the portrait (0), field of view in degrees (25; the head stays as large), "
           "degrees "
           "round the head to the viewer's right (0).",
       .on_set = core_.Command([this](const vm::SetValue& value) {
         Camera camera = FirstScene().camera;
         float* const fields[] = {&camera.distance, &camera.height_mm, &camera.field_degrees,
                                  &camera.angle_degrees};
         for (std::size_t i = 0; i < value.size(); ++i) {
           *fields[i] = static_cast<float>(value.number(i));
         }
         core_.scene.camera = camera;
       })});
}

void SceneSlots::DeclareLight(const std::string& name, const std::string& what,
                              DirectionalLight Scene::*lamp) {
  core_.slots.Declare(
      {.name = name,
       .grammar = "<number 0..10> [ <number -180..180> <number -90..90> ] [ <word> ]",
       .initial = "1",
       .help = what +
               ": its strength (1 = as usual), where it stands (degrees to the viewer's right, "
               "degrees up; left out = as usual), and its colour, #rrggbb (left out = as usual).",
       .on_set = core_.Command([this, lamp](const vm::SetValue& value) -> vm::Result<void> {
         DirectionalLight set;
         set.strength = static_cast<float>(value.number(0));
         if (value.size() >= 3) {
           const float side = glm::radians(static_cast<float>(value.number(1)));
           const float up = glm::radians(static_cast<float>(value.number(2)));
           set.direction = glm::vec3(std::sin(side) * std::cos(up), std::sin(up),
                                     std::cos(side) * std::cos(up));
         }
         if (value.size() == 2 || value.size() == 4) {
           const std::string& text = value.word(value.size() - 1);
           const auto colour = ParseColour(text);
           if (!colour) {
             return vm::Fail(vm::Errc::kBadValue, "'" + text + "' is no colour; #rrggbb expected");
           }
           set.tint = LinearColour(*colour);
         }
         core_.scene.*lamp = set;
         return {};
       })});
}

void SceneSlots::DeclareSaveImage() {
  core_.slots.Declare(
      {.name = "SaveImage",
       .grammar = "<file>",
       .access = vm::Access::kWriteOnly,
       .help =
           "Writes a picture of the face, .png, .bmp or .rgb by the name: as it will be when the "
           "changes begun before this command have settled, at most 2 s ahead.",
       .on_set_later = [this](const vm::SetValue& value, const vm::Reply& reply) {
         // The state is a function of time, so the face can be drawn at once as it will be after
         // its onsets, unaffected by later commands.
         const vm::Time now = core_.Now();
         const vm::Time at = std::min(core_.motion->OnsetsSettled(now), now + kLongestSettling);
         auto done = core_.DrawAt(at);
         if (done) done = core_.files.write_picture(core_.view.Read(), value.word(0));
         core_.changed();
         if (!done) return reply.Fail(done.error());
         reply.Ok(value.word(0));
       }});
}

vm::Result<void> SceneSlots::FillScreen(bool fill) {
  ViewWindow* const window = core_.view.window();
  if (window == nullptr) {
    return vm::Fail(vm::Errc::kUnavailable, "there is no window to fill the screen with");
  }
  window->FillScreen(fill);
  fills_screen_ = fill;
  return {};
}

vm::Result<void> SceneSlots::ResetSize() {
  if (fills_screen_) {
    if (auto done = FillScreen(false); !done) return done;
  }
  return core_.view.Resize(start_width_, start_height_);
}

void SceneSlots::Reset() {
  core_.scene = FirstScene();
  transparent_ = false;
  background_enabled_ = true;
  core_.simulates = true;
  if (auto sized = ResetSize(); !sized) core_.slots.ReportError("Window", sized.error());
  if (auto set = SetBackground(first_); !set) {
    core_.slots.ReportError("Background", set.error());
    StorePlain();
  }
}

}  // namespace fsm
