#include "fsm/app/background_slots.h"

#include <algorithm>

#include "fsm/app/slot_words.h"
#include "vm_protocol/core/lower_case.h"
#include "vm_protocol/core/or_throw.h"

namespace fsm {
namespace {

constexpr const char* kPlain = "plain";              // the background without a picture
constexpr const char* kStudio = "studio";            // a wall, brighter behind the head
constexpr const char* kTransparent = "transparent";  // no background

bool IsPictureName(const std::string& name) {
  const std::string lower = vm::LowerCase(name);
  return lower.ends_with(".png") || lower.ends_with(".bmp") || lower.ends_with(".rgb");
}

}  // namespace

BackgroundSlots::BackgroundSlots(FsmCore& core,
                                 std::vector<std::pair<std::string, std::string>> backgrounds,
                                 const std::string& first)
    : core_(core),
      backgrounds_(std::move(backgrounds)),
      first_(!first.empty()         ? first
             : backgrounds_.empty() ? kPlain
                                    : backgrounds_.front().first) {
  Declare();
  if (auto set = Set(first_); !set) {
    if (!first.empty()) vm::OrThrow(set);
    // A missing picture of the configuration is not an error.
    core_.log("notice: background " + first_ + ": " + set.error().text +
              "; the plain one is shown");
    StorePlain();
  }
}

void BackgroundSlots::Declare() {
  const bool lists_ours = core_.conventions.lists_our_backgrounds || backgrounds_.empty();
  std::string names = lists_ours ? std::string(kPlain) + "," + kStudio : "";
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
         if (auto set = Set(value.word(0)); !set) return set;
         core_.slots.Report("NowBackground", value.word(0));
         return {};
       })});
  core_.slots.Declare(
      {.name = "ViewBackground",
       .grammar = "ENABLE | DISABLE",
       .initial = "ENABLE",
       .help = "Whether the background is drawn; without it pictures are transparent there.",
       .on_set = core_.Command([this](const vm::SetValue& value) {
         enabled_ = value.word(0) == "ENABLE";
         Show();
       })});
}

vm::Result<void> BackgroundSlots::Set(const std::string& name) {
  auto background = Find(name);
  if (!background) return std::unexpected(background.error());
  background_ = std::move(*background);
  Show();
  return {};
}

vm::Result<Background> BackgroundSlots::Find(const std::string& name) const {
  if (name == kTransparent) return Transparent{};
  if (name == kPlain) return kPlainBackground;
  if (name == kStudio) return StudioWall{};
  if (const auto colour = ParseColour(name)) return *colour;
  const auto named =
      std::ranges::find(backgrounds_, name, &std::pair<std::string, std::string>::first);
  if (named == backgrounds_.end() && !IsPictureName(name)) {
    return vm::Fail(vm::Errc::kBadValue,
                    "there is no background '" + name + "'; " + core_.slots.Value("BackgroundSet") +
                        ", transparent, a .png, .bmp or .rgb file or #rrggbb expected");
  }
  auto picture = core_.files.read_image(named == backgrounds_.end() ? name : named->second);
  if (!picture) return std::unexpected(picture.error());
  return std::make_shared<const Image>(std::move(*picture));
}

void BackgroundSlots::StorePlain() {
  for (const char* slot : {"Background", "NowBackground"}) core_.slots.Store(slot, kPlain);
}

void BackgroundSlots::Show() { core_.scene.background = enabled_ ? background_ : Transparent{}; }

void BackgroundSlots::RestoreInitial() {
  background_ = kPlainBackground;
  enabled_ = true;
  if (auto set = Set(first_); !set) {
    core_.slots.ReportError("Background", set.error());
    StorePlain();
  }
}

}  // namespace fsm
