#pragma once

#include <functional>
#include <set>
#include <string>

#include "agent_manager/access/rights.h"
#include "agent_manager/routing/requests.h"

namespace am {

/// Messages on their way to one peer: in words it understands, and not before it is known which
/// those are. A module that knows tags gets ours and start times on its own clock; one of the
/// original gets bare lines, its starts held back until their time; a client gets what was said.
/// Files named for a role that may not name all are looked at here, once the module has told which
/// of its slots take them. Thread: the scheduler's. All that it is given outlives it.
class ModuleLines {
 public:
  ModuleLines(vm::Scheduler& clock, Directory& directory, Outbox& outbox, Requests& requests,
              const AccessControl& access, const Limits& limits);

  void Forward(Peer& peer, vm::Message message, const Origin& origin, OnAnswer done);
  /// What has waited until the module was known.
  void FlushWaiting(Peer& peer);
  /// To be told that a remote peer's clock is needed before a start time can be sent to it.
  void set_on_clock_needed(std::function<void(PeerKey)> needed) {
    clock_needed_ = std::move(needed);
  }

  /// Modules on the virtual clock follow ours exactly (docs/architecture.md "Time").
  void set_lockstep(bool lockstep) { lockstep_ = lockstep; }
  bool lockstep() const { return lockstep_; }
  /// Lockstep: tells a module how far its clock may go.
  void Grant(Peer& module, vm::Time until, OnAnswer done);
  /// Modules something was sent to since their last grant.
  std::set<PeerKey>& dirty() { return dirty_; }

  /// True while messages are held back until their time.
  bool HasHeld() const { return held_ > 0; }
  void CountHeld(int change) { held_ += change; }
  /// The peer goes: what was held for it is given up.
  void Forget(Peer& peer);

 private:
  bool MustWait(Peer& peer, const vm::Message& message, const Origin& origin);
  vm::Result<void> CheckFiles(const Peer& peer, const vm::Message& message, Role role) const;
  void ForwardOriginal(Peer& module, vm::Message message, const Origin& origin,
                       const OnAnswer& done);
  bool HoldStart(Peer& module, const vm::Message& message);
  void SendBare(Peer& module, vm::Message message, PeerKey commander);
  void AskFiles(Peer& module);

  vm::Scheduler& clock_;
  Directory& directory_;
  Outbox& outbox_;
  Requests& requests_;
  const AccessControl& access_;
  const Limits& limits_;
  std::function<void(PeerKey)> clock_needed_;
  std::set<PeerKey> dirty_;
  int held_ = 0;
  bool lockstep_ = false;
};

}  // namespace am
