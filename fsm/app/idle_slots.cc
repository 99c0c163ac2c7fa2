#include "fsm/app/idle_slots.h"

#include "fsm/app/slot_words.h"
#include "fsm/motion/inputs/idle_kinds.h"

namespace fsm {
namespace {

std::string Profiles(const FsmCore& core) {
  std::string names = "OFF";
  for (const auto& [name, profile] : core.motion->tables().motions.profiles) names += " " + name;
  return names;
}

/// Joins the results of `text_of` for all kinds with a separator.
template <typename TextOf>
std::string Kinds(const std::string& separator, const TextOf& text_of) {
  std::string text;
  for (const IdleKindRow& row : IdleKinds()) {
    text += (text.empty() ? "" : separator) + text_of(row);
  }
  return text;
}

void DeclareGaze(FsmCore& core) {
  core.slots.Declare(
      {.name = "Gaze",
       .grammar = "USER | THINK | <number -60..60> <number -60..60> [ <ms> ]",
       .initial = "0 0",
       .help = "Looks at the user and stays there while the head turns; looks away here and there "
               "as one who thinks; or looks x y degrees away (x+ = down, y+ = to the viewer's "
               "right) with the eyes, and with the head where that is far, for so many ms; without "
               "them until the next.",
       .on_set = core.Command([&core](const vm::SetValue& value) {
         const vm::Time now = core.Now();
         if (value.word(0) == "USER") {
           core.motion->eyes.GazeAtUser(now);
         } else if (value.word(0) == "THINK") {
           core.motion->eyes.Think(now);
         } else {
           core.motion->eyes.Gaze(now, {RealOf(value, 0), RealOf(value, 1)},
                                  FromMs(value.size() > 2 ? value.number(2) : 0));
         }
       })});
  core.slots.Declare(
      {.name = "Gaze.distance",
       .grammar = "FAR | <number 100..10000>",
       .initial = "700",
       .help = "How far away what Gaze looks at is, in mm: the eyes converge on it. FAR = they are "
               "parallel. For the next Gaze.",
       .on_set = core.Setting([](MotionSettings& settings, const vm::SetValue& value) {
         settings.gaze_distance_mm = value.word(0) == "FAR" ? 0 : value.number(0);
       })});
}

}  // namespace

void DeclareIdleSlots(FsmCore& core, const std::string& life) {
  core.slots.Declare(
      {.name = "Autonomous",
       .grammar = "( " +
                  Kinds(" | ", [](const IdleKindRow& row) { return std::string(row.name); }) +
                  " ) <int 0..>",
       .access = vm::Access::kWriteOnly,
       .help = "What the face does by itself, and its pattern; 0 stops it. " +
               Kinds("; ",
                     [](const IdleKindRow& row) {
                       return std::string(row.name) + std::string(row.help);
                     }) +
               ".",
       .on_set = core.Command([&core](const vm::SetValue& value) {
         return core.motion->switches().Set(core.Now(), value.word(0),
                                            static_cast<int>(value.number(1)));
       })});
  core.slots.Declare({.name = "Life",
                      .grammar = "<word>",
                      .initial = life,
                      .help = "All of Autonomous at once: " + Profiles(core) +
                              ". What a profile does not name is "
                              "switched off; single parts can be switched afterwards.",
                      .on_set = core.Command([&core](const vm::SetValue& value) {
                        return core.motion->switches().SetProfile(core.Now(), value.word(0));
                      })});
  DeclareGaze(core);
}

}  // namespace fsm
