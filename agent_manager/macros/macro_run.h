#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agent_manager/macros/sequence.h"

namespace am {

/// One execution of a macro: its steps, after a failure or a stop those of on_stop, and at last
/// those of finally. Failures of on_stop and finally are skipped. Lifetime: the services outlive
/// it; it shares the macro, which may be deleted meanwhile. Thread: the scheduler's.
class MacroRun {
 public:
  /// A request to run the macro: its variables, on whose behalf, and where to answer.
  struct Successor {
    Variables variables;
    Origin origin;
    vm::Reply reply;
  };
  /// `on_end` is called once, from the hub's queue.
  MacroRun(MacroServices& services, std::shared_ptr<const Macro> macro, Successor start,
           std::function<void()> on_end);

  void Begin();
  /// Goes on with on_stop and finally. Does nothing if they have begun.
  void Fail(const vm::Error& error);
  /// Stops it at the request of a peer, which is answered when the run has ended.
  void Stop(const vm::Reply& reply);
  /// Answers every waiting peer with `error` now; the steps go on.
  void Abandon(const vm::Error& error);
  /// True if `peer` waits for the end of this run or of the one after it.
  bool IsAwaitedBy(PeerKey peer) const;
  /// Stops it; `successor` starts when it has ended. A successor set before is refused.
  void ReplaceBy(Successor successor);
  void OnReport(const std::string& from, const std::string& slot, const std::string& value,
                bool told);
  void OnGone(const std::string& module, const std::string& reason);
  /// Answers every waiting peer. Returns the successor, if any.
  std::optional<Successor> Finish();

  const Macro& macro() const { return *state_.macro; }

 private:
  enum class Phase { kSteps, kStopping, kFinally };
  void Enter(Phase phase);
  void OnPhaseEnd(const std::optional<vm::Error>& error);

  MacroServices& services_;
  RunState state_;
  Variables variables_;
  vm::Reply reply_;
  std::function<void()> on_end_;
  Phase phase_ = Phase::kSteps;
  std::shared_ptr<Sequence> sequence_;
  std::optional<vm::Error> error_;
  std::vector<vm::Reply> stop_replies_;
  std::optional<Successor> successor_;
};

}  // namespace am
