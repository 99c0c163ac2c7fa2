#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vm_protocol/core/scheduler.h"
#include "vm_protocol/core/slot_machine.h"

namespace vm {

/// The core of one program of the toolkit: a slot machine that lives on a scheduler. It does no
/// input or output of the protocol itself; whoever owns it (RunModule, a test, a larger program)
/// feeds `slots().HandleLine` and takes what comes out.
/// Lifetime: the scheduler outlives the module. Thread: the scheduler's.
///
/// Everything a module does in time, it does through the scheduler; it must keep no timer pending
/// when it has nothing to do (on the virtual clock, time jumps to the next timer).
class Module {
 public:
  virtual ~Module() = default;
  virtual SlotMachine& slots() = 0;
  /// What to send to a peer that has just connected; the original's modules say `rep Run = LIVE`.
  virtual std::vector<Message> Greeting() { return {Rep("Run", "LIVE")}; }
  /// True while work with an end is going on (speaking, preparing, rendering a film): end of input
  /// and `set Wait = IDLE` wait for it.
  virtual bool Busy() const { return false; }
  /// True once `set Run = EXIT` was taken: the runtime then shuts the module down and ends.
  virtual bool ExitRequested() const { return false; }
  /// Called once when input has ended and nothing is pending, or on `Run = EXIT`: finish files.
  virtual void Shutdown() {}
};

/// What every module has beside its own slots: Run (LIVE, EXIT), ModuleVersion, ProtocolVersion.
struct CommonSlots {
  std::string module_version{};     ///< the value of ModuleVersion
  std::string protocol_version{};   ///< the value of ProtocolVersion
  bool quoted_versions = false;     ///< the original voice module quotes them, its face does not
  bool auto_output = false;         ///< default for Run
  bool report_exit = true;          ///< `rep Run = EXIT` is sent (the original face sends nothing)
  std::function<void()> on_init{};  ///< for `set Run = INIT`; empty = INIT is not accepted
  /// For `set Run = START`, before the report; an error leaves Run as it was. Empty = START and
  /// STOP are not accepted.
  std::function<Result<void>()> on_start{};
  std::function<void()> on_stop{};  ///< for `set Run = STOP`, after the report
  std::string work{};               ///< for the help of Run: what is done from START on
  std::function<void()> on_exit{};  ///< for `set Run = EXIT`, after the report
};
void DeclareCommonSlots(SlotMachine& slots, const CommonSlots& common);

}  // namespace vm
