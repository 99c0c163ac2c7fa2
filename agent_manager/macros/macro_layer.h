#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "agent_manager/macros/built_in_machine.h"
#include "agent_manager/macros/macro_run.h"

namespace am {

/// The macro layer (MCL), addressed as @AM-MCL (and @FS-MCL): every macro is a slot; setting it
/// runs the macro, and the answer comes when the run ends. One run per macro at a time: a new one
/// stops the one before (barge-in). Reports of a stopped run are not taken for those of the next,
/// which starts only when the modules have reported that they are idle, or after a time limit.
/// Lifetime: the clock and the hub outlive it. Thread: the scheduler's.
/// Limits: kMaxMacros macros with kMaxMacroBytes of text; Sequence has those of one run.
class MacroLayer final : public BuiltInMachine {
 public:
  static constexpr std::size_t kMaxMacros = 1024;
  static constexpr std::size_t kMaxAwaited = 8192;  ///< slots and events that macros wait for
  static constexpr std::size_t kMaxMacroBytes = 8u << 20;
  using ReadFile = std::function<vm::Result<std::string>(const std::string& path)>;
  MacroLayer(vm::Scheduler& clock, Hub& hub, ReadFile read_file,
             std::function<void(const std::string& path)> remove_file);
  MacroLayer(const MacroLayer&) = delete;

  vm::SlotMachine& slots() override { return slots_; }
  /// Sets variables from the value of each macro whose "reads" is `name`, besides its words.
  using Reader = std::function<void(Variables& variables)>;
  void AddReader(std::string name, Reader reader) { readers_[std::move(name)] = std::move(reader); }
  /// Declares a slot that is no macro. REQUIRES: the name is new and valid, the grammar
  /// well-formed.
  void Declare(vm::SlotSpec slot) { slots_.Declare(std::move(slot)); }
  /// Adds or replaces a macro; a run under way keeps its old steps. Errors: kBadValue, kAccess for
  /// the name of a slot that is no macro, kLimit.
  vm::Result<void> Define(Macro macro);
  /// Errors: kUnknownSlot. A run under way keeps its steps.
  vm::Result<void> Remove(const std::string& name);

  void Handle(const Envelope& envelope) override;
  void OnReport(const std::string& from, const vm::Message& message) override;
  void OnPresence(const std::string& name, bool present, const std::string& reason) override;
  void Abandon(const vm::Error& error) override;
  bool IsAwaitedBy(PeerKey peer) const override;
  bool Busy() const override { return !runs_.empty(); }
  bool Has(const std::string& name) const { return macros_.contains(name); }
  /// In lockstep, modules have the same time: a common start does not allow for their delays.
  void set_lockstep(bool lockstep) { services_.lockstep = lockstep; }

 private:
  bool OnDefinition(const vm::Message& message, const vm::Reply& reply);
  vm::Result<std::string> DefineBy(const vm::Message& message);
  void Start(const std::string& name, const vm::SetValue& value, const vm::Reply& reply);
  void Begin(const std::string& name, MacroRun::Successor start);
  void Finish(const std::string& name);
  void StopWithoutRun(const Macro& macro);
  /// What is known of a slot or event that some macro waits for.
  struct Awaited {
    bool is_value = false;     ///< a slot's value, whose reports may have to be switched on
    bool switched_on = false;  ///< they have been, since its module came
    /// The last value is remembered if it is no longer than the longest that a step compares it to.
    std::optional<std::size_t> remembered{};
  };
  using Place = std::pair<std::string, std::string>;  // module, slot or event
  vm::Result<void> CheckAwaited(const Macro& macro) const;
  static void CollectFrom(const Macro& macro, std::map<Place, Awaited>& awaited);
  void CollectAwaited();
  void SwitchOn(const std::string& module);

  Hub& hub_;
  ReadFile read_file_;
  vm::SlotMachine slots_;
  MacroServices services_;
  std::map<std::string, std::shared_ptr<const Macro>> macros_;
  std::map<std::string, Reader> readers_;
  std::map<std::string, std::unique_ptr<MacroRun>> runs_;  // by macro
  std::map<Place, Awaited> awaited_;
  std::size_t bytes_ = 0;
  Origin origin_;  // of the message being handled
};

}  // namespace am
