#include "agent_manager/slots/built_in_dispatcher.h"

#include <utility>

namespace am {

using vm::Command;
using vm::Message;
using vm::Relation;
using vm::Result;

BuiltInDispatcher::BuiltInDispatcher(Hub& hub, vm::SlotMachine& am, const MacroLayer& macros,
                                     std::span<BuiltInMachine* const> machines,
                                     LineScripts::ReadFile read_file)
    : hub_(hub), am_(am), macros_(macros), scripts_(hub, std::move(read_file)) {
  for (BuiltInMachine* const machine : machines) machines_[&machine->slots()] = machine;
  hub_.router().set_on_machine([this](vm::SlotMachine& machine, const Envelope& envelope) {
    return Take(machine, envelope);
  });
}

Result<void> BuiltInDispatcher::CheckFiles(const vm::SlotMachine& machine,
                                           const Envelope& envelope) {
  if (hub_.access().AllFiles(envelope.origin.role)) return {};
  const Message& message = envelope.message;
  const bool kept =
      message.command == Command::kDo && (scripts_.Has(message.slot) || macros_.Has(message.slot));
  if (kept) return {};
  return hub_.access().CheckFiles(envelope.origin.role, message, SlotsOf(machine), "");
}

const FileSlots& BuiltInDispatcher::SlotsOf(const vm::SlotMachine& machine) {
  DeclaredFiles& known = files_[&machine];
  if (std::string declared = machine.Value("Slots.files"); declared != known.text)
    known = {declared, FileSlots(declared)};
  return known.slots;
}

Result<Router::Taken> BuiltInDispatcher::Take(vm::SlotMachine& machine, const Envelope& envelope) {
  if (const auto checked = CheckFiles(machine, envelope); !checked)
    return std::unexpected(checked.error());
  const Message& message = envelope.message;
  const bool defines_lines =
      message.command == Command::kDef &&
      (message.relation == Relation::kAppend || message.relation == Relation::kFromFile);
  const bool does = message.command == Command::kDo && !macros_.Has(message.slot);
  const bool deletes = message.command == Command::kDel && scripts_.Has(message.slot);
  const bool of_scripts = &machine == &am_ ? defines_lines || does || deletes : does;
  if (of_scripts) {
    auto done = Script(envelope);
    if (!done) return std::unexpected(done.error());
    return Router::Taken{true, std::move(*done)};
  }
  const auto own = machines_.find(&machine);
  if (own == machines_.end()) return Router::Taken{};
  own->second->Handle(envelope);
  return Router::Taken{.taken = true};
}

Result<std::string> BuiltInDispatcher::Script(const Envelope& envelope) {
  const Message& message = envelope.message;
  if (message.command == Command::kDo) {
    const auto lines =
        scripts_.Do(message.slot.empty() ? message.value : message.slot, envelope.origin);
    if (!lines) return std::unexpected(lines.error());
    return std::to_string(*lines) + " lines";
  }
  const auto allowed =
      hub_.access().CheckPermission(envelope.origin.role, Permission::kDefine, "define macros");
  if (!allowed) return std::unexpected(allowed.error());
  if (message.command == Command::kDel) {
    scripts_.Delete(message.slot);
    return "deleted";
  }
  const auto kept = message.relation == Relation::kAppend
                        ? scripts_.Append(message.slot, message.value)
                        : scripts_.Load(message.slot, message.value);
  if (!kept) return std::unexpected(kept.error());
  return message.value;
}

}  // namespace am
