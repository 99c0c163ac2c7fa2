#pragma once

#include <functional>

#include "agent_manager/routing/directory.h"
#include "agent_manager/routing/limits.h"
#include "vm_protocol/core/scheduler.h"

namespace am {

/// What peers may do to each other by speaking much or reading little: a flood is read slower, who
/// speaks to a full reader waits for it, and a reader that takes nothing is cut off. Nobody else
/// waits. Thread: the scheduler's. The directory and the limits outlive it.
class BackPressure {
 public:
  /// Told of a peer that has to go; it is not gone yet when the call returns.
  using OnCutOff = std::function<void(PeerKey peer, const std::string& why)>;
  BackPressure(vm::Scheduler& clock, Directory& directory, const Limits& limits,
               OnCutOff on_cut_off);

  /// Measures a peer's rates. Call before its message is dealt with. `bytes`: of its line.
  void Meter(Peer& sender, std::size_t bytes);
  /// Call after something was sent to a peer. `commander`: whose command it was; kHub: nobody's, or
  /// a report. A module has many hearers, and one of them must not stop it for the others.
  void AfterSend(Peer& receiver, PeerKey commander);
  /// Those who wait for this reader go on.
  void Release(Peer& reader);
  /// Does not read from a peer until LetGo, which may come as often; false in lockstep.
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
