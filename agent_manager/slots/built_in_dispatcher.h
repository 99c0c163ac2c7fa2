#pragma once

#include <map>
#include <span>

#include "agent_manager/access/file_slots.h"
#include "agent_manager/macros/built_in_machine.h"
#include "agent_manager/macros/line_scripts.h"
#include "agent_manager/macros/macro_layer.h"
#include "agent_manager/routing/hub.h"

namespace am {

/// What reaches the hub's own machines, @AM, @AM-MCL, @PAR and @SND: whether the files it names may
/// be named, and `do`, whose lines go through the hub like any other. Thread: the scheduler's. All
/// that it is given outlives it.
class BuiltInDispatcher {
 public:
  BuiltInDispatcher(Hub& hub, vm::SlotMachine& am, const MacroLayer& macros,
                    std::span<BuiltInMachine* const> machines, LineScripts::ReadFile read_file);

 private:
  vm::Result<Router::Taken> Take(vm::SlotMachine& machine, const Envelope& envelope);
  vm::Result<void> CheckFiles(const vm::SlotMachine& machine, const Envelope& envelope);
  /// Which of its slots take file names; read anew only when the machine declares others.
  const FileSlots& SlotsOf(const vm::SlotMachine& machine);
  vm::Result<std::string> Script(const Envelope& envelope);

  Hub& hub_;
  vm::SlotMachine& am_;
  const MacroLayer& macros_;
  std::map<const vm::SlotMachine*, BuiltInMachine*> machines_;
  struct DeclaredFiles {
    std::string text;
    FileSlots slots;
  };
  std::map<const vm::SlotMachine*, DeclaredFiles> files_;
  LineScripts scripts_;
};

}  // namespace am
