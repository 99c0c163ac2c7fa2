#include "fsm/app/expression_slots.h"

#include <charconv>
#include <optional>

namespace fsm {
namespace {

constexpr std::string_view kPrefix = "FaceExp.";
constexpr std::size_t kMostOwnSlots = 200;

struct Name {
  std::string expression;
  int pattern = 1;
};
// "FaceExp.SMIRK" or "FaceExp.SMIRK.2"; none for other slots.
std::optional<Name> NameOf(std::string_view slot) {
  if (!slot.starts_with(kPrefix) || slot == "FaceExp.onset" || slot == "FaceExp.point") {
    return std::nullopt;
  }
  slot.remove_prefix(kPrefix.size());
  Name name;
  if (const std::size_t dot = slot.find('.'); dot != slot.npos) {
    const std::string_view digits = slot.substr(dot + 1);
    const auto [end, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), name.pattern);
    if (error != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
    slot = slot.substr(0, dot);
  }
  name.expression = slot;
  return name;
}

std::string SlotOf(const std::string& expression, int pattern) {
  return std::string(kPrefix) + expression + "." + std::to_string(pattern);
}

void DeclareOne(FsmCore& core, const Name& name, const std::string& initial) {
  core.Declare({.name = SlotOf(name.expression, name.pattern),
                .grammar = "<text>",
                .help = "What pattern " + std::to_string(name.pattern) + " of " + name.expression +
                        " looks like: units and strengths, gaze:DOWN,RIGHT.",
                .action =
                    [&core, name](const vm::SetValue& value) {
                      return core.motion->expression.Define(name.expression, name.pattern,
                                                            value.text);
                    },
                .initial = initial});
}

std::string LookOf(const FsmCore& core, const Name& name) {
  const EmotionTable& emotions = core.motion->tables().emotions;
  const auto found = emotions.find(name.expression);
  const auto index = static_cast<std::size_t>(name.pattern - 1);
  if (found == emotions.end() || index >= found->second.patterns.size()) return "";
  return FormatLook(found->second.patterns[index], core.motion->tables().unit_names);
}

vm::Result<std::string> Define(FsmCore& core, const Name& name, const std::string& look) {
  const std::string slot = SlotOf(name.expression, name.pattern);
  const bool known = core.slots.Has(slot);
  if (!known && core.initial_values.size() >= core.declared_at_start + kMostOwnSlots) {
    return vm::Fail(vm::Errc::kLimit, "more than " + std::to_string(kMostOwnSlots) +
                                          " patterns of expressions were defined");
  }
  auto done = core.motion->expression.Define(name.expression, name.pattern, look);
  if (!done) return std::unexpected(done.error());
  if (!known) DeclareOne(core, name, "");
  const std::string written = LookOf(core, name);
  core.slots.Report(slot, written);
  core.changed();
  return written;
}

void Forget(FsmCore& core, const std::string& expression) {
  core.motion->expression.Forget(expression);
  for (int pattern = 1; core.slots.Has(SlotOf(expression, pattern)); ++pattern) {
    core.slots.Store(SlotOf(expression, pattern), LookOf(core, {expression, pattern}));
  }
}

}  // namespace

void DeclareExpressionSlots(FsmCore& core) {
  for (const auto& [expression, emotion] : core.motion->tables().emotions) {
    for (std::size_t i = 0; i < emotion.patterns.size(); ++i) {
      DeclareOne(core, {expression, static_cast<int>(i) + 1},
                 FormatLook(emotion.patterns[i], core.motion->tables().unit_names));
    }
  }
  core.slots.set_definition_hook([&core](const vm::Message& message, vm::PeerId,
                                         const vm::Reply& reply) {
    const auto name = NameOf(message.slot);
    if (!name) return false;
    if (message.command == vm::Command::kDef && message.relation == vm::Relation::kAssign) {
      auto done = Define(core, *name, message.value);
      if (done) {
        reply.Ok(*done);
      } else {
        reply.Fail(done.error());
      }
      return true;
    }
    if (message.command != vm::Command::kDel) return false;
    if (!core.motion->tables().emotions.contains(name->expression)) {
      reply.Fail({vm::Errc::kUnknownSlot, "there is no expression '" + name->expression + "'", 0});
      return true;
    }
    Forget(core, name->expression);
    reply.Ok("deleted");
    return true;
  });
}

}  // namespace fsm
