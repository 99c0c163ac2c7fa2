#include "agent_manager/routing/module_clocks.h"

#include <algorithm>
#include <utility>

namespace am {

using vm::Message;
using vm::Result;

namespace {

constexpr int kExchanges = 5;  // when a module comes; the quickest one counts
// Another hub's clock is measured less often, and only where start times have been sent: all agents
// measuring all others would be most of what a broker has to do.
constexpr unsigned kRemoteEvery = 5;  // rounds of MeasureAll
constexpr int kSilentRounds = 4;      // of EndProbes, for a module that has said nothing yet

}  // namespace

ModuleClocks::ModuleClocks(vm::Scheduler& clock, Directory& directory, Outbox& outbox,
                           Requests& requests, ClockGrants& grants, Forwarder& forwarder,
                           OnKnown on_known)
    : clock_(clock),
      directory_(directory),
      outbox_(outbox),
      requests_(requests),
      grants_(grants),
      forwarder_(forwarder),
      on_known_(std::move(on_known)) {
  forwarder_.set_on_clock_wanted([this](Peer& peer) { return WantClock(peer); });
}

void ModuleClocks::Probe(Peer& module) {
  module.probe.probing = true;
  Message question = vm::Inq("Clock");
  question.tag = requests_.Add(
      module, {kHub, question,
               [this, key = module.key, asked_at = clock_.Now()](const Result<std::string>& value) {
                 Peer* const answering = directory_.ByKey(key);
                 if (answering != nullptr && answering->probe.probing)
                   BecomeModern(*answering, asked_at, value);
               },
               vm::Time(0)});
  outbox_.Write(module, question, kHub);
}

void ModuleClocks::BecomeModern(Peer& module, vm::Time asked_at, const Result<std::string>& clock) {
  // A refusal with our tag is an answer too: such a module knows tags, but has no clock.
  module.dialect = Dialect::kModern;
  module.probe.probing = false;
  grants_.Begin(module);
  // In lockstep time waits for every clock that is known: never for a guest's.
  const bool kept_out = grants_.lockstep() && module.role == Role::kGuest;
  if (clock && !kept_out) Sample(module, asked_at, *clock);
  outbox_.Write(
      module, Message{{}, "", vm::Command::kProp, "", "Error", vm::Relation::kAssign, "AutoOutput"},
      kHub);
  if (module.probe.clock.known) {
    forwarder_.Forward(module, vm::Set("Clock.mode", grants_.lockstep() ? "HUB" : "REAL"),
                       Origin::OfHub(), IgnoreAnswer);
    if (grants_.lockstep()) {
      grants_.Grant(module, clock_.Now(), IgnoreAnswer);  // from here on its clock is ours
    } else {
      Measure(module, kExchanges);
    }
  }
  forwarder_.FlushWaiting(module);
  on_known_(module);
}

void ModuleClocks::Sample(Peer& peer, vm::Time asked_at, const std::string& value) {
  const auto theirs = vm::ParseMs(value.substr(0, value.find(' ')));
  if (!theirs) return;
  peer.probe.estimate.Add(asked_at, clock_.Now(), *theirs);
  peer.probe.clock = {true, peer.probe.estimate.offset(), peer.probe.estimate.delay()};
}

void ModuleClocks::Measure(Peer& peer, int exchanges) {
  if (exchanges <= 0) {
    if (std::exchange(peer.probe.measuring, false)) forwarder_.FlushWaiting(peer);
    return;
  }
  forwarder_.Forward(
      peer, vm::Inq("Clock"), Origin::OfHub(),
      [this, key = peer.key, asked_at = clock_.Now(), exchanges](const Result<std::string>& value) {
        Peer* const answering = directory_.ByKey(key);
        if (answering == nullptr) return;
        if (value) Sample(*answering, asked_at, *value);
        Measure(*answering, value ? exchanges - 1 : 0);
      });
}

bool ModuleClocks::WantClock(Peer& peer) {
  if (std::exchange(peer.probe.asked_clock, true)) return false;
  peer.probe.measuring = true;
  clock_.Post([this, key = peer.key] {
    if (Peer* const there = directory_.ByKey(key)) Measure(*there, kExchanges);
  });
  return true;
}

void ModuleClocks::MeasureAll() {
  for (const PeerKey key : WithClock()) Measure(*directory_.ByKey(key), 2);
  if (++rounds_ % kRemoteEvery != 0) return;
  for (const auto& [key, peer] : directory_.peers()) {
    if (peer->kind == PeerKind::kRemote && peer->probe.asked_clock) Measure(*peer, 2);
  }
}

ClockState ModuleClocks::ClockOf(std::string_view name) const {
  const Peer* const peer = directory_.Find(name);
  return peer == nullptr ? ClockState{} : peer->probe.clock;
}

void ModuleClocks::EndProbes(const std::set<PeerKey>& modules) {
  for (const PeerKey key : modules) {
    Peer* const peer = directory_.ByKey(key);
    if (peer == nullptr || !peer->probe.probing) continue;
    // One that has said nothing at all yet may still be starting, on a busy machine.
    if (!peer->spoken && ++peer->probe.silent_rounds < kSilentRounds) continue;
    outbox_.Notice("@" + peer->name +
                   " has no slot Clock: it works, but by this machine's time, so what it does in a "
                   "film is not placed exactly. To be exact it needs that slot (docs/protocol.md, "
                   "Time; modules made with our libraries have it)" +
                   (peer->configured ? "; where this is enough, \"dialect\": \"original\" in its "
                                       "configuration spares the wait for it"
                                     : ""));
    peer->probe.probing = false;
    peer->dialect = Dialect::kOriginal;
    requests_.Forget(*peer);
    forwarder_.FlushWaiting(*peer);
    on_known_(*peer);
  }
}

std::set<PeerKey> ModuleClocks::Probing() const {
  std::set<PeerKey> keys;
  for (const auto& [key, peer] : directory_.peers()) {
    if (peer->probe.probing) keys.insert(key);
  }
  return keys;
}

bool ModuleClocks::ProbingConfigured() const {
  return std::ranges::any_of(directory_.peers(), [](const auto& entry) {
    return entry.second->probe.probing && entry.second->configured;
  });
}

std::vector<PeerKey> ModuleClocks::WithClock() const {
  std::vector<PeerKey> keys;
  for (const auto& [key, peer] : directory_.peers()) {
    if (peer->kind == PeerKind::kModule && peer->dialect == Dialect::kModern &&
        peer->probe.clock.known)
      keys.push_back(key);
  }
  return keys;
}

}  // namespace am
