#include "fsm/app/expression_slots.h"

#include <charconv>
#include <optional>

namespace fsm {
namespace {

constexpr std::string_view kPrefix = "FaceExp.";

using Name = ExpressionSlots::Name;

// Parses "FaceExp.SMIRK" or "FaceExp.SMIRK.2"; nothing for other slots.
std::optional<Name> ParseSlotName(std::string_view slot) {
  if (!slot.starts_with(kPrefix)) return std::nullopt;
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

std::string SlotOf(const Name& name) {
  return std::string(kPrefix) + name.expression + "." + std::to_string(name.pattern);
}

}  // namespace

ExpressionSlots::ExpressionSlots(FsmCore& core) : core_(core) {
  for (const auto& [word, expression] : core_.motion->expressions().all()) {
    for (std::size_t i = 0; i < expression.patterns.size(); ++i) {
      const Name name{word, static_cast<int>(i) + 1};
      Declare(name, LookOf(name).value_or(""));
    }
  }
  core_.slots.set_definition_hook(
      [this](const vm::Message& message, vm::PeerId, const vm::Reply& reply) {
        const auto name = ParseSlotName(message.slot);
        if (!name) return false;
        const bool known = core_.motion->expressions().all().contains(name->expression);
        if (!known && core_.slots.Has(message.slot)) return false;  // FaceExp.onset and its like
        const bool defines =
            message.command == vm::Command::kDef && message.relation == vm::Relation::kAssign;
        if (!defines && message.command != vm::Command::kDel) return false;
        const auto done = defines ? Define(*name, message.value) : Forget(name->expression);
        core_.notify_changed();
        done ? reply.Ok(*done) : reply.Fail(done.error());
        return true;
      });
}

void ExpressionSlots::RestoreInitial() {
  for (const std::string& slot : own_) core_.slots.Remove(slot);
  own_.clear();
}

void ExpressionSlots::Declare(const Name& name, const std::string& look) {
  core_.slots.Declare(
      {.name = SlotOf(name),
       .grammar = "<text>",
       .initial = look,
       .help = "What pattern " + std::to_string(name.pattern) + " of " + name.expression +
               " looks like: units and strengths, gaze:DOWN,RIGHT.",
       .on_set = core_.Command([this, name](const vm::SetValue& value) {
         return core_.motion->expressions().Define(name.expression, name.pattern, value.text);
       })});
}

std::optional<std::string> ExpressionSlots::LookOf(const Name& name) const {
  const ExpressionTable& expressions = core_.motion->expressions().all();
  const auto found = expressions.find(name.expression);
  const auto index = static_cast<std::size_t>(name.pattern - 1);
  if (found == expressions.end() || index >= found->second.patterns.size()) return {};
  return FormatLook(found->second.patterns[index], core_.motion->tables().unit_names);
}

vm::Result<std::string> ExpressionSlots::Define(const Name& name, const std::string& look) {
  const std::string slot = SlotOf(name);
  const bool known = core_.slots.Has(slot);
  if (!known && own_.size() >= kMaxOwnSlots) {
    return vm::Fail(vm::Errc::kLimit, "more than " + std::to_string(kMaxOwnSlots) +
                                          " patterns of expressions were defined");
  }
  if (auto done = core_.motion->expressions().Define(name.expression, name.pattern, look); !done) {
    return std::unexpected(done.error());
  }
  if (!known) {
    Declare(name, "");
    own_.push_back(slot);
  }
  const std::string written = LookOf(name).value_or("");
  core_.slots.Report(slot, written);
  return written;
}

vm::Result<std::string> ExpressionSlots::Forget(const std::string& expression) {
  if (!core_.motion->expressions().all().contains(expression)) {
    return vm::Fail(vm::Errc::kUnknownSlot, "there is no expression '" + expression + "'");
  }
  core_.motion->expressions().Forget(expression);
  for (Name name{expression, 1}; core_.slots.Has(SlotOf(name)); ++name.pattern) {
    const std::string slot = SlotOf(name);
    if (const auto look = LookOf(name)) {
      core_.slots.Store(slot, *look);
    } else {
      core_.slots.Remove(slot);
      std::erase(own_, slot);
    }
  }
  return "deleted";
}

}  // namespace fsm
