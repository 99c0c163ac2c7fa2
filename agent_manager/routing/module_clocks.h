#pragma once

#include <functional>
#include <set>
#include <string_view>
#include <vector>

#include "agent_manager/routing/forwarder.h"

namespace am {

/// Finds out what each module knows by asking for its clock, and keeps measuring where that stands
/// (docs/architecture.md "Time"). Thread: the scheduler's. All that it is given outlives it.
class ModuleClocks {
 public:
  /// A module can be spoken to from now on.
  using OnKnown = std::function<void(Peer& module)>;
  ModuleClocks(vm::Scheduler& clock, Directory& directory, Outbox& outbox, Requests& requests,
               ClockGrants& grants, Forwarder& forwarder, OnKnown on_known);

  void Probe(Peer& module);
  /// Modules that are still being asked what they are.
  std::set<PeerKey> Probing() const;
  /// True while a module of the configuration is being asked. What is said to others waits for
  /// them alone.
  bool ProbingConfigured() const;
  /// Those among `modules` that have not answered by now count as original; one that has said
  /// nothing at all is given four times as long.
  void EndProbes(const std::set<PeerKey>& modules);

  /// Asks every module with a clock for it again (real clock only).
  void MeasureAll();
  /// A start time is to be said to this peer of another hub: true if its clock is measured first.
  bool WantClock(Peer& peer);
  ClockState ClockOf(std::string_view name) const;
  /// Modules of ours that have a clock.
  std::vector<PeerKey> WithClock() const;

 private:
  void Measure(Peer& peer, int exchanges);
  void Sample(Peer& peer, vm::Time asked_at, const std::string& value);
  void BecomeModern(Peer& module, vm::Time asked_at, const vm::Result<std::string>& clock);

  vm::Scheduler& clock_;
  Directory& directory_;
  Outbox& outbox_;
  Requests& requests_;
  ClockGrants& grants_;
  Forwarder& forwarder_;
  OnKnown on_known_;
  unsigned rounds_ = 0;
};

}  // namespace am
