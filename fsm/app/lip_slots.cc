#include "fsm/app/lip_slots.h"

#include <algorithm>
#include <glm/vec2.hpp>
#include <optional>
#include <tuple>

#include "fsm/app/slot_words.h"
#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

std::string SlotOf(VisemeSetId set, const std::string& viseme) {
  return (set == VisemeSetId::k28 ? "MouthShape28." : "MouthShape.") + viseme;
}

constexpr SlotWord<LipMode> kModes[] = {{"DOMINANCE", LipMode::kDominance},
                                        {"SINUSOID", LipMode::kSinusoid},
                                        {"LINEAR", LipMode::kLinear}};

/// Returns the values of LipSync.scale: the sizes of jaw and lip movements in per cent.
std::vector<SlotWord<glm::vec2>> WaysOfSpeaking(const MovementNumbers& gestures) {
  const auto& [jaw, lips] = std::tie(gestures.jaw, gestures.lips);
  return {{"MUMBLED", {jaw.mumbled, lips.mumbled}},
          {"SOFT", {jaw.soft, lips.soft}},
          {"NORMAL", {jaw.normal, lips.normal}},
          {"CLEAR", {jaw.clear, lips.clear}},
          {"SHOUTED", {jaw.shouted, lips.shouted}}};
}

/// Returns the set that the first number of a value names.
vm::Result<VisemeSetId> SetNamed(const vm::SetValue& value) {
  const auto set = SetOfCount(static_cast<std::size_t>(value.number(0)));
  if (set) return *set;
  return vm::Fail(vm::Errc::kBadValue,
                  "there are sets of 14 and of 28 mouth shapes; 14 or 28 expected");
}

vm::Result<void> ChooseVisemes(MotionSettings& settings, const vm::SetValue& value) {
  const auto set = SetNamed(value);
  if (!set) return std::unexpected(set.error());
  settings.lips.visemes = *set;
  return {};
}

/// `names`: the names of all lists, separated by blanks.
vm::Result<void> SetNames(const std::string& names, MotionSettings& settings,
                          const std::string& word) {
  if ((" " + names + " ").find(" " + word + " ") == std::string::npos) {
    return vm::Fail(vm::Errc::kBadValue,
                    "'" + word + "' is no list of phoneme names; " + names + " expected");
  }
  settings.lips.engine = word;
  return {};
}

void DeclareStyle(FsmCore& core) {
  const std::string engines = EngineList(core.motion->tables().engines);
  const auto ways = WaysOfSpeaking(core.motion->tables().gestures);
  core.slots.Declare(
      {.name = "LipSync.mode",
       .grammar = GrammarOf(kModes),
       .initial = "DOMINANCE",
       .help = "How lips go from sound to sound: by overlapping dominance curves with "
               "anticipation, by the original's sinusoids, or by straight lines.",
       .on_set = core.Setting([](MotionSettings& settings, const vm::SetValue& value) {
         settings.lips.mode = *ValueOf(kModes, value.word(0));
       })});
  core.slots.Declare(
      {.name = "LipSync.shapes",
       .grammar = "<int 14..28>",
       .initial = "28",
       .help = "Which mouth shapes: 28 of English and Japanese, or the original's 14.",
       .on_set = core.Setting(ChooseVisemes)});
  core.slots.Declare(
      {.name = "LipSync.names",
       .grammar = "<word>",
       .initial = "AUTO",
       .help = "Whose names the phonemes have: AUTO (whichever knows most of the list) or one "
               "of " +
               engines + ".",
       .on_set = core.Setting(
           [names = "AUTO " + engines](MotionSettings& settings, const vm::SetValue& value) {
             return SetNames(names, settings, value.word(0));
           })});
  core.slots.Declare(
      {.name = "LipSync.scale",
       .grammar = GrammarOf(ways) + " | <number 0..300> [ <number 0..300> ]",
       .initial = "NORMAL",
       .help = "How large the next utterances are articulated: a way of speaking, or per cent for "
               "the jaw and for the lips. Closures stay closed.",
       .on_set = core.Setting([ways](MotionSettings& settings, const vm::SetValue& value) {
         const glm::vec2 scale =
             ValueOf(ways, value.word(0))
                 .value_or(glm::vec2(value.number(0), value.number(value.size() > 1 ? 1 : 0)));
         settings.lips.jaw = scale.x / 100;
         settings.lips.lips = scale.y / 100;
       })});
}

void DeclareVisemes(FsmCore& core, VisemeSetId set) {
  for (const Viseme& viseme : core.motion->visemes(set)) {
    core.slots.Declare(
        {.name = SlotOf(set, viseme.name),
         .grammar = "<number>...",
         .initial = FormatVisemeValues(viseme),
         .help = "Mouth shape '" + viseme.name + "' of the " + std::to_string(CountOf(set)) +
                 ": 17 mouth parameters [seal [tongue [hold]]], see face.md.",
         .on_set = core.Command(
             [&core, set, name = viseme.name](const vm::SetValue& value) -> vm::Result<void> {
               std::vector<std::string> words;
               for (std::size_t i = 0; i < value.size(); ++i) words.push_back(value.word(i));
               Visemes visemes = core.motion->visemes(set);
               for (Viseme& edited : visemes) {
                 if (edited.name != name) continue;
                 if (auto read = ReadVisemeValues(words, 0, edited); !read) return read;
               }
               core.motion->SetVisemes(set, std::move(visemes));
               return {};
             })});
  }
}

// Loads a table of 14 or 28 rows; the number of rows determines the set.
vm::Result<void> LoadVisemes(FsmCore& core, const std::string& path) {
  const auto text = ReadTableFile(path);
  if (!text) return std::unexpected(text.error());
  const VisemeSetId set = SetOfCount(Table(path, *text).rows().size()).value_or(VisemeSetId::k14);
  auto visemes = ReadVisemes(path, *text, set);
  if (!visemes) return std::unexpected(visemes.error());
  const Visemes& now = core.motion->visemes(set);
  for (std::size_t i = 0; i < now.size(); ++i) {
    if ((*visemes)[i].name != now[i].name) {
      return vm::Fail(vm::Errc::kBadValue, path + ": shape " + std::to_string(i + 1) + " is '" +
                                               (*visemes)[i].name + "', '" + now[i].name +
                                               "' expected");
    }
  }
  core.motion->SetVisemes(set, std::move(*visemes));
  for (const Viseme& viseme : core.motion->visemes(set)) {
    core.slots.Report(SlotOf(set, viseme.name), FormatVisemeValues(viseme));
  }
  return {};
}

vm::Result<void> SaveVisemes(FsmCore& core, VisemeSetId set, const std::string& path) {
  std::string text =
      "# Mouth shapes: name, the 17 mouth parameters, seal, tongue, hold (docs/face.md).\n";
  for (const Viseme& viseme : core.motion->visemes(set)) {
    text += viseme.name + " " + FormatVisemeValues(viseme) + "\n";
  }
  return vm::WriteTextFile(path, text);
}

void DeclareVisemeFiles(FsmCore& core) {
  core.slots.Declare(
      {.name = "MouthShapes",
       .grammar = "<file>",
       .access = vm::Access::kWriteOnly,
       .help = "Loads a table of mouth shapes, all 14 or all 28; rows as in mouth_shapes.txt.",
       .on_set = core.Command(
           [&core](const vm::SetValue& value) { return LoadVisemes(core, value.word(0)); })});
  core.slots.Declare(
      {.name = "SaveMouthShapes",
       .grammar = "<int 14..28> <word>",
       .access = vm::Access::kWriteOnly,
       .help = "Writes the 14 or the 28 mouth shapes to a file, as MouthShapes loads them.",
       .on_set = core.Command([&core](const vm::SetValue& value) -> vm::Result<void> {
         const auto set = SetNamed(value);
         if (!set) return std::unexpected(set.error());
         return SaveVisemes(core, *set, value.word(1));
       })});
}

}  // namespace

void DeclareLipSlots(FsmCore& core) {
  DeclareStyle(core);
  for (const VisemeSetId set : kVisemeSets) DeclareVisemes(core, set);
  DeclareVisemeFiles(core);
}

}  // namespace fsm
