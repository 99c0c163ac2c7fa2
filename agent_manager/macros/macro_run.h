#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "agent_manager/macros/sequence.h"

namespace am {

/// One macro being carried out: its steps, after a failure or a stop those of on_stop, and at every
/// end those of finally. Thread: the scheduler's.
class MacroRun {
 public:
  /// What shall happen when this run has ended.
  struct Successor {
    Variables variables;
    Origin origin;
    vm::Reply reply;
  };
  /// `on_end` is called from the queue, once.
  MacroRun(MacroServices& services, std::shared_ptr<const Macro> macro, Successor start,
           std::function<void()> on_end);

  void Begin();
  /// Ends its steps; what ends already goes on.
  void Fail(const vm::Error& error);
  /// A stop asked for by a peer, which is answered at the end.
  void Stop(const vm::Reply& reply);
  /// Answers everybody at once; the steps go on.
  void Abandon(const vm::Error& error);
  /// True if `peer` waits for its end.
  bool IsAwaitedBy(PeerKey peer) const;
  /// Another begins when this one has ended; one that waited before is told that it does not.
  void ReplaceBy(Successor successor);
  void OnReport(const std::string& from, const std::string& slot, const std::string& value,
                bool told);
  void OnGone(const std::string& module, const std::string& reason);
  /// Tells everybody how it ended. Returns who comes next.
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
