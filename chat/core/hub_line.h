#pragma once

#include <functional>
#include <map>
#include <string>

#include "vm_protocol/core/client.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"

namespace chat {

/// What this module says to the others by the hub, with answers and time limits.
/// Lifetime: clock and slots outlive it. Thread: the scheduler's.
class HubLine {
 public:
  using OnAnswer = vm::Client::OnAnswer;
  HubLine(vm::Scheduler& clock, vm::SlotMachine& slots);
  ~HubLine();
  HubLine(const HubLine&) = delete;

  void Say(const vm::Message& message) { slots_.Say(message); }
  /// Answered once: the value, the refusal, or kTimeout after `limit`.
  void Ask(vm::Message message, vm::Time limit, OnAnswer on_answer);
  /// What came from another module; answers find their questions.
  void Hear(const vm::Message& message);

 private:
  vm::Scheduler& clock_;
  vm::SlotMachine& slots_;
  vm::Client client_;
  std::map<std::string, vm::TimerId> timers_;  // by tag
};

}  // namespace chat
