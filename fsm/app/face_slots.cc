#include "fsm/app/face_slots.h"

#include "fsm/app/slot_words.h"

namespace fsm {
namespace {

constexpr SlotWord<Onset> kOnsets[] = {
    {"POSED", Onset::kPosed}, {"ELICITED", Onset::kElicited}, {"NATURAL", Onset::kPosed}};

Angles AnglesOf(const FsmCore& core, const vm::SetValue& value) {
  return {RealOf(value, 0), RealOf(value, 1), core.conventions.tilt * RealOf(value, 2)};
}

// Returns 12 for "Face.12".
int NumberOf(const std::string& slot) { return std::stoi(slot.substr(slot.find('.') + 1)); }

vm::Result<void> SetBlendShapes(FsmCore& core, const vm::SetValue& value) {
  const vm::Time now = core.Now();
  const bool timed = value.size() % 2 == 1;
  const vm::Time move = FromMs(timed ? value.number(value.size() - 1) : 60);
  // Check all names before anything moves.
  for (std::size_t i = 0; i + 1 < value.size(); i += 2) {
    if (auto known = core.motion->blend_shapes.Check(value.word(i)); !known) return known;
  }
  for (std::size_t i = 0; i + 1 < value.size(); i += 2) {
    auto set = core.motion->blend_shapes.Set(now, value.word(i), value.number(i + 1), move);
    if (!set) return set;
  }
  return {};
}

void DeclareUnits(FsmCore& core) {
  int position = 0;
  for (const auto& [unit, emotion] : core.motion->tables().unit_list.face_slots) {
    const std::string what =
        unit > 0 ? "action unit " + std::to_string(unit) : "expression " + emotion;
    core.slots.Declare({.name = "Face." + std::to_string(++position),
                        .grammar = "<number>",
                        .initial = "0",
                        .help = "Strength of " + what + " in per cent, 0 to 200.",
                        .on_set = core.Clamped(0, 200, [&core](const vm::SetValue& value) {
                          return core.motion->SetListedUnit(core.Now(), NumberOf(value.slot),
                                                            value.number(0) / 100);
                        })});
  }
  for (std::size_t i = 1; i <= kMouthParameters; ++i) {
    core.slots.Declare(
        {.name = "Mouth." + std::to_string(i),
         .grammar = "<number>",
         .initial = "0",
         .help = "Strength of mouth parameter " + std::to_string(i) + " in per cent, 0 to 200.",
         .on_set = core.Clamped(0, 200, [&core](const vm::SetValue& value) {
           return core.motion->mouth.Set(core.Now(), NumberOf(value.slot), value.number(0) / 100);
         })});
  }
  core.slots.Declare(
      {.name = "AU",
       .grammar = "<text>",
       .access = vm::Access::kWriteOnly,
       .help = "Moves action units: number (or name) with L or R for one side, then the strength "
               "(0 to 2, 1 = full, or a letter A to E), as many as wanted; at the end the ms it "
               "takes (60). 30 and 46 (a wink) are of one side, the agent's left if none is named. "
               "51-58 "
               "move the head, 61-66 the eyes. `12L 0.7 6 C 200`",
       .on_set = core.Command([&core](const vm::SetValue& value) {
         return core.motion->action_units.Set(core.Now(), value.text);
       })});
  core.slots.Declare(
      {.name = "ARKit",
       .grammar = "( <word> <number 0..1> )... [ <ms> ]",
       .access = vm::Access::kWriteOnly,
       .help = "Moves blend shapes of ARKit's names: name and weight, as many as wanted, and the "
               "ms it takes (60).",
       .on_set = core.Command(
           [&core](const vm::SetValue& value) { return SetBlendShapes(core, value); })});
  core.slots.Declare(
      {.name = "Asymmetry",
       .grammar = "<number 0..300>",
       .initial = "100",
       .help = "How unlike the two sides of the face move, in per cent of what this face has by "
               "itself (a few per cent of each unit); 0 = both alike. Which side is first in time "
               "is Autonomous' ASYMMETRY.",
       .on_set = core.Command([&core](const vm::SetValue& value) {
         core.motion->asymmetry = static_cast<float>(value.number(0) / 100);
       })});
}

void DeclareExpressions(FsmCore& core) {
  core.slots.Declare(
      {.name = "FaceExp",
       .grammar =
           "NEUTRAL [ <int> <number> <ms> ] | <word> [ <int 1..> [ <number 0..200> [ <ms> ] ] ]",
       .initial = "NEUTRAL",
       .help = "An expression: HAPPY ANGRY DISGUSTED SAD SURPRISED FEARED or USERDEF, its pattern "
               "(1 to 5), its strength in per cent and its duration in ms (0 = until the next), "
               "left out 1 100 0; or NEUTRAL.",
       .on_set = core.Command([&core](const vm::SetValue& value) -> vm::Result<void> {
         if (value.word(0) == "NEUTRAL") {
           core.motion->expression.Neutral(core.Now());
           return {};
         }
         const auto number = [&value](std::size_t place, double left_out) {
           return value.size() > place ? value.number(place) : left_out;
         };
         return core.motion->expression.Show(core.Now(), value.word(0),
                                             static_cast<int>(number(1, 1)), number(2, 100) / 100,
                                             FromMs(number(3, 0)));
       })});
  core.slots.Declare(
      {.name = "FaceExp.point",
       .grammar = "<number -2..2> <number -2..2> <number -2..2> [ <ms> ]",
       .initial = "0 0 0",
       .help = "An expression as a point of the emotion space, and the ms it takes to get there "
               "(as FaceExp.onset says); 0 0 0 = at rest. +x happy, -x sad, +y surprised, -y "
               "disgusted, +z angry, -z feared; 1 from the middle is full strength. What was set "
               "last counts, this or FaceExp.",
       .on_set = core.Command([&core](const vm::SetValue& value) -> vm::Result<void> {
         core.motion->expression.ShowSpacePoint(
             core.Now(), {RealOf(value, 0), RealOf(value, 1), RealOf(value, 2)},
             value.size() > 3 ? std::optional(FromMs(value.number(3))) : std::nullopt);
         return {};
       })});
  core.slots.Declare(
      {.name = "Mood",
       .grammar = "NEUTRAL | <word> <number 0..100>",
       .initial = "NEUTRAL",
       .help = "A slight look that stays until the next, and its strength in per cent: AROUSED or "
               "LOW (MOOD lines of motions.txt), as vdm tells it of a voice; or NEUTRAL. "
               "Expressions cover it.",
       .on_set = core.Command([&core](const vm::SetValue& value) {
         return core.motion->mood.Set(core.Now(), value.word(0),
                                      value.size() > 1 ? value.number(1) / 100 : 0);
       })});
  const MotionSettings& settings = core.motion->settings();
  core.slots.Declare(
      {.name = "FaceExp.onset",
       .grammar = GrammarOf(kOnsets) + " | <ms>",
       .initial = settings.onset == Onset::kFixed ? vm::FormatMs(settings.expression)
                                                  : WordOf(kOnsets, settings.onset),
       .help = "How long an expression takes to come: as measured on people who show (POSED, or "
               "NATURAL) or feel (ELICITED) it, each emotion by itself; or so many ms.",
       .on_set = core.Setting([](MotionSettings& changed, const vm::SetValue& value) {
         changed.onset = ValueOf(kOnsets, value.word(0)).value_or(Onset::kFixed);
         if (changed.onset == Onset::kFixed) changed.expression = FromMs(value.number(0));
       })});
}

void DeclareHead(FsmCore& core) {
  const std::string axes =
      "x y z in degrees, -90 to 90: x+ = down, y+ = to the viewer's right, z+ = tilt there (with "
      "-C to his left, as in the original).";
  core.slots.Declare({.name = "HeadRotAbs.1",
                      .grammar = "<number> <number> <number>",
                      .initial = "0 0 0",
                      .help = "Turns the head to " + axes,
                      .on_set = core.Clamped(-90, 90, [&core](const vm::SetValue& value) {
                        core.motion->head.TurnTo(core.Now(), AnglesOf(core, value));
                      })});
  core.slots.Declare({.name = "HeadRotRel.1",
                      .grammar = "<number> <number> <number>",
                      .access = vm::Access::kWriteOnly,
                      .help = "Turns the head further by " + axes,
                      .on_set = core.Clamped(-90, 90, [&core](const vm::SetValue& value) {
                        core.motion->head.TurnBy(core.Now(), AnglesOf(core, value));
                      })});
  core.slots.Declare(
      {.name = "FaceMot",
       .grammar = "NOMOVE [ <int> ] | ( NOD | REFUSE | SHAKE | LISTEN | TILT | BLINK | USERDEF ) "
                  "<int 1..> "
                  "[ <number 0..300> [ <int 1..20> ] ]",
       .access = vm::Access::kWriteOnly,
       .help = "One movement and its pattern, its strength in per cent (100) and how many times "
               "(1), or NOMOVE to end what is moving. SHAKE is REFUSE, TILT is LISTEN.",
       .on_set = core.Command([&core](const vm::SetValue& value) -> vm::Result<void> {
         if (value.word(0) == "NOMOVE") {
           core.motion->StopMovements(core.Now());
           return {};
         }
         return core.motion->PlayMovement(core.Now(), value.word(0),
                                          static_cast<int>(value.number(1)),
                                          value.size() > 2 ? value.number(2) / 100 : 1,
                                          value.size() > 3 ? static_cast<int>(value.number(3)) : 1);
       })});
}

void DeclareEyes(FsmCore& core) {
  const auto eyes = [&core](const std::string& name, const Sided<bool>& sides, const char* which) {
    core.slots.Declare(
        {.name = name,
         .grammar = "<number -90..90> <number -90..90> <ms>",
         .access = vm::Access::kWriteOnly,
         .help = std::string("Turns ") + which +
                 " by x y degrees (x+ = down, y+ = to the viewer's right) for so many ms; "
                 "0 = until the next.",
         .on_set = core.Command([&core, sides](const vm::SetValue& value) {
           core.motion->eyes.Rotate(core.Now(), sides, {RealOf(value, 0), RealOf(value, 1)},
                                    FromMs(value.number(2)));
         })});
  };
  eyes("EyeRot", {.right = true, .left = true}, "both eyes");
  eyes("EyeRotRight", {.right = true}, "the agent's right eye");
  eyes("EyeRotLeft", {.left = true}, "the agent's left eye");
}

}  // namespace

void DeclareFaceSlots(FsmCore& core) {
  DeclareUnits(core);
  DeclareExpressions(core);
  DeclareHead(core);
  DeclareEyes(core);
}

void DeclareFigureSlots(FsmCore& core) {
  const auto declare = [&core](const char* name, const char* grammar, const char* help,
                               const char* initial, auto change) {
    core.slots.Declare({.name = name,
                        .grammar = grammar,
                        .initial = initial,
                        .help = help,
                        .on_set = core.Command([&core, change](const vm::SetValue& value) {
                          change(core.motion->figure, value);
                        })});
  };
  declare("AgentEnable", "ENABLE | DISABLE", "Whether the agent is drawn.", "ENABLE",
          [](Figure& figure, const vm::SetValue& value) {
            figure.enabled = value.word(0) == "ENABLE";
          });
  declare("AgentAlpha", "<number 0..1>", "Opacity of the agent, 0 = not to be seen.", "1.0",
          [](Figure& figure, const vm::SetValue& value) { figure.alpha = RealOf(value, 0); });
  declare("AgentRot", "<number -360..360> <number -360..360> <number -360..360>",
          "Turns the whole figure: x y z in degrees, x+ = down, y+ = right, z+ = tilt to the "
          "viewer's right (with -C to his left, as in the original).",
          "0 0 0", [&core](Figure& figure, const vm::SetValue& value) {
            figure.rotation = AnglesOf(core, value);
          });
  declare("AgentTrans", "<number -10000..10000> <number -10000..10000>",
          "Moves the whole figure: x to the right and y up, in mm at the face; with -C in halves "
          "of the view's longer side, as in the original.",
          "0 0", [](Figure& figure, const vm::SetValue& value) {
            figure.translation = {RealOf(value, 0), RealOf(value, 1)};
          });
  declare("AgentScale", "<number 0.01..100>", "Size of the whole figure, 1.0 = normal.", "1.0",
          [](Figure& figure, const vm::SetValue& value) { figure.scale = RealOf(value, 0); });
}

}  // namespace fsm
