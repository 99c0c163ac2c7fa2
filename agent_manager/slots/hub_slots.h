#pragma once

#include <functional>
#include <set>
#include <string>

#include "agent_manager/routing/hub.h"
#include "agent_manager/supervision/supervisor.h"
#include "vm_protocol/core/slot_machine.h"

namespace am {

/// Declares the slots of @AM: peers and their traffic, limits, modules. Everything passed to the
/// constructor outlives it. Thread: the scheduler's.
class HubSlots {
 public:
  struct Hooks {
    std::function<void()> on_exit;
    std::function<void(const vm::SetValue&, const vm::Reply&)> on_wait;
    std::function<void(const vm::Reply&)> on_reload;
    /// A peer subscribes to a module, which may be another hub's.
    std::function<void(const std::string& name, Role role)> on_want;
    std::function<void(PeerKey peer, bool on)> on_flow;
  };
  HubSlots(vm::Scheduler& clock, Hub& hub, Supervisor& supervisor, vm::SlotMachine& slots,
           Hooks hooks);
  /// Declares Module.NAME.state and so on for these modules, and removes those of others.
  void DeclareModules(const std::set<std::string>& names);

 private:
  void DeclareForPeers();
  void DeclareOverviews();
  vm::Result<std::string> Subscribe(const vm::SetValue& value);
  void DeclareProcesses();
  void DeclareLimits();
  void DeclareModule(const std::string& name);

  vm::Scheduler& clock_;
  Hub& hub_;
  Supervisor& supervisor_;
  vm::SlotMachine& slots_;
  Hooks hooks_;
  std::set<std::string> modules_;
};

}  // namespace am
