#pragma once

#include <set>

#include "agent_manager/routing/requests.h"

namespace am {

/// Lockstep (docs/architecture.md "Time"): tells each module on the virtual clock how far its clock
/// may go, and sees to it that no message reaches a module whose clock is behind ours.
/// Thread: the scheduler's. All that it is given outlives it.
class ClockGrants {
 public:
  ClockGrants(vm::Scheduler& clock, Outbox& outbox, Requests& requests)
      : clock_(clock), outbox_(outbox), requests_(requests) {}

  void set_lockstep(bool lockstep) { lockstep_ = lockstep; }
  bool lockstep() const { return lockstep_; }
  /// The module's clock stands where ours does.
  void Begin(Peer& module) { module.granted = clock_.Now(); }
  /// Says `set Clock = UNTIL`; the answer tells the module's next event.
  void Grant(Peer& module, vm::Time until, OnAnswer done);
  /// To be called before anything is sent to a module: a command, an answer, or a report it hears.
  void BeforeSending(Peer& module);
  /// True if a module was sent something after its last grant, so that its next event is not known.
  bool AnyOutdated() const { return !outdated_.empty(); }
  void Forget(const Peer& peer) { outdated_.erase(peer.key); }

 private:
  vm::Scheduler& clock_;
  Outbox& outbox_;
  Requests& requests_;
  std::set<PeerKey> outdated_;
  bool lockstep_ = false;
};

}  // namespace am
