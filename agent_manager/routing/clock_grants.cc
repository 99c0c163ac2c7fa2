#include "agent_manager/routing/clock_grants.h"

#include <utility>

namespace am {

void ClockGrants::Grant(Peer& module, vm::Time until, OnAnswer done) {
  vm::Message request = vm::Set("Clock", vm::FormatMs(until));
  module.granted = until;
  request.tag = requests_.Add(module, {kHub, request, std::move(done), vm::Time(0)});
  outbox_.Write(module, request, kHub);
  outdated_.erase(module.key);
}

void ClockGrants::BeforeSending(Peer& module) {
  if (!lockstep_ || !module.probe.clock.known) return;
  if (module.granted < clock_.Now()) Grant(module, clock_.Now(), IgnoreAnswer);
  outdated_.insert(module.key);
}

}  // namespace am
