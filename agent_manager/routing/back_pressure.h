#pragma once

#include <functional>

#include "agent_manager/routing/directory.h"
#include "agent_manager/routing/limits.h"
#include "vm_protocol/core/scheduler.h"

namespace am {

/// Protects peers from each other: a peer that sends faster than its rate is read slower, a peer
/// that commands a full reader is not read from until that has read, and a reader that takes
/// nothing for Limits::stall_ms is cut off. No other peer waits. Thread: the scheduler's. The
/// directory and the limits outlive it.
class BackPressure {
 public:
  /// Told of a peer that has to go; it is not gone yet when the call returns.
  using OnCutOff = std::function<void(PeerKey peer, const std::string& why)>;
  BackPressure(vm::Scheduler& clock, Directory& directory, const Limits& limits,
               OnCutOff on_cut_off);

  /// Measures a peer's rates. Call before its message is dealt with. `bytes`: of its line.
  void Meter(Peer& sender, std::size_t bytes);
  /// Call after something was sent to a peer. `commander`: the peer whose command it was, which
  /// waits if the receiver is full; kHub for a report, because one slow hearer of a module must not
  /// stop it for the others.
  void AfterSend(Peer& receiver, PeerKey commander);
  /// Those who wait for this reader go on.
  void Release(Peer& reader);
  /// Stops reading from a peer until LetGo was called as often as Hold. False in lockstep, where
  /// nobody is held.
  bool Hold(Peer& sender) const;
  static void LetGo(Peer& sender);
  /// In lockstep time stands while others work: nobody is held.
  void set_lockstep(bool lockstep) { lockstep_ = lockstep; }

 private:
  void Watch(Peer& reader);
  void Look(PeerKey key);
  void CutOff(Peer& peer, const std::string& why);

  vm::Scheduler& clock_;
  Directory& directory_;
  const Limits& limits_;
  OnCutOff on_cut_off_;
  bool lockstep_ = false;
};

}  // namespace am
