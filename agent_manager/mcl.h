#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "agent_manager/hub.h"
#include "agent_manager/macro.h"
#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"

namespace am {

/// The macro layer (MCL), addressed as @AM-MCL (and @FS-MCL): every macro is a slot; setting it
/// runs the macro, and the answer comes when the run ends. One run per macro at a time: a new one
/// stops the one before (barge-in). Reports of a stopped run are never taken for those of the next,
/// since the next starts only when the modules have said they are idle, or their time for it is
/// over. Thread: the scheduler's. The hub outlives it.
class Mcl {
 public:
  using RemoveFile = std::function<void(const std::string& path)>;
  /// Reads the file of `def NAME < FILE`.
  using ReadFile = std::function<vm::Result<std::string>(const std::string& path)>;
  Mcl(vm::Scheduler& clock, Hub& hub, ReadFile read_file, RemoveFile remove_file);
  ~Mcl();
  Mcl(const Mcl&) = delete;

  vm::SlotMachine& slots() { return slots_; }
  /// A macro that exists is replaced (not while it runs: kBusy).
  vm::Result<void> Define(Macro macro);
  /// Feed what modules say, and their comings and goings.
  void OnReport(const std::string& from, const vm::Message& message);
  void OnPresence(const std::string& name, bool present, const std::string& reason);
  bool Busy() const { return !runs_.empty(); }
  /// On a clock of lockstep the start of speaking needs no room for delays.
  void set_lockstep(bool lockstep) { lockstep_ = lockstep; }

 private:
  struct Run;
  struct Heard {
    std::string from, slot, value;
  };
  void DeclareStatusSlots();
  bool OnDefinition(const vm::Message& message, const vm::Reply& reply);
  void Start(const std::string& name, const vm::SetValue& value, const vm::Reply& reply);
  void Begin(const std::string& name, Variables variables, const vm::Reply& reply);
  void Stop(Run& run, const std::string& why);
  void Fail(Run& run, vm::Error error);
  void Advance(Run& run);
  /// False if the step has to wait for something.
  bool Do(Run& run, const MacroStep& step);
  bool Send(Run& run, const MacroStep& step);
  bool Wait(Run& run, const MacroStep& step);
  void Finish(Run& run);
  // mcl_branches.cc
  void StartBranches(Run& run, const std::vector<const std::vector<MacroStep>*>& branches);
  void FinishBranch(Run& branch);
  void FailBranch(Run& branch, vm::Error error);
  void EndBranches(Run& run);
  bool Holds(const Run& run, const MacroStep& step) const;
  vm::Time StartLead(const std::vector<std::string>& modules) const;
  void WatchSlots(const std::string& module);
  Run* Find(unsigned long id);
  Run* RunOf(const std::string& macro);

  vm::Scheduler& clock_;
  Hub& hub_;
  ReadFile read_file_;
  RemoveFile remove_file_;
  vm::SlotMachine slots_;
  std::map<std::string, std::shared_ptr<const Macro>> macros_;
  std::map<unsigned long, std::unique_ptr<Run>> runs_;
  std::map<std::pair<std::string, std::string>, std::string>
      last_;  // (module, slot) -> last report
  Variables kept_;
  unsigned long last_run_ = 0;
  bool lockstep_ = false;
};

}  // namespace am
