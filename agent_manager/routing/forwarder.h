#pragma once

#include <functional>

#include "agent_manager/routing/clock_grants.h"
#include "agent_manager/routing/file_guard.h"
#include "agent_manager/routing/held_starts.h"

namespace am {

/// The last step of a message on its way to a peer. It waits here until the hub knows what the
/// module is, and is then said in the receiver's dialect: a module that knows tags gets our tag and
/// start times on its own clock, a module of the original gets bare lines, a client gets the
/// message as it is. Thread: the scheduler's. All that it is given outlives it. Limits:
/// Limits::waiting messages wait for one peer; further ones are answered with LIMIT.
class Forwarder {
 public:
  Forwarder(vm::Scheduler& clock, Directory& directory, Outbox& outbox, Requests& requests,
            ClockGrants& grants, const AccessControl& access, const Limits& limits);

  /// `done`, or else the peer of the origin, gets the answer.
  void Forward(Peer& peer, vm::Message message, const Origin& origin, OnAnswer done);
  /// The module is known now: what has waited for that is said.
  void FlushWaiting(Peer& peer);
  /// Called when a start time is to be said to a peer of another hub: true if it has to wait until
  /// the peer's clock has been measured.
  void set_on_clock_wanted(std::function<bool(Peer& peer)> wanted) {
    clock_wanted_ = std::move(wanted);
  }
  /// True while messages wait for their time.
  bool HoldsBack() const { return starts_.count() > 0 || files_.count() > 0; }
  /// The peer goes: what waits for it is answered with UNAVAILABLE.
  void Forget(Peer& peer);

 private:
  bool MustWait(Peer& peer, const vm::Message& message, const Origin& origin);
  void KeepWaiting(Peer& peer, vm::Message message, const Origin& origin, OnAnswer done);
  void ForwardOriginal(Peer& module, vm::Message message, const Origin& origin,
                       const OnAnswer& done);

  Outbox& outbox_;
  Requests& requests_;
  ClockGrants& grants_;
  const Limits& limits_;
  FileGuard files_;
  HeldStarts starts_;
  std::function<bool(Peer& peer)> clock_wanted_;
};

}  // namespace am
