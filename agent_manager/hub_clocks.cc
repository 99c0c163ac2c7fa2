// What modules know and where their clocks stand.

#include <utility>

#include "agent_manager/hub.h"
#include "agent_manager/hub_peer.h"
#include "vm_protocol/core/start_time.h"

namespace am {

using vm::Command;
using vm::Error;
using vm::Message;
using vm::Result;

namespace {

// Another hub's clock is measured less often, and only where start times have been sent: all agents
// measuring all others would be most of what a broker has to do.
constexpr unsigned kRemoteEvery = 5;  // rounds of MeasureClocks
constexpr int kSilentRounds = 4;      // of EndProbes, for a module that has said nothing yet

}  // namespace

void Hub::Probe(Peer& peer) {
  peer.probing = true;
  const unsigned long number = ++last_tag_;
  Message question = vm::Inq("Clock");
  peer.pending[number] = {
      kHub, question,
      [this, key = peer.key, asked_at = clock_.Now()](const Result<std::string>& value) {
        Peer* answering = ByKey(key);
        if (answering == nullptr || !answering->probing) return;
        BecomeModern(*answering, asked_at, value);
      }};
  question.tag = HubTag(number);
  Write(peer, vm::FormatMessage(question));
}

void Hub::BecomeModern(Peer& peer, vm::Time asked_at, const Result<std::string>& clock) {
  // A refusal with our tag is an answer too: such a module knows tags, but has no clock.
  peer.dialect = Dialect::kModern;
  peer.probing = false;
  peer.granted = clock_.Now();
  if (clock) SampleClock(peer, asked_at, *clock);
  SendBare(peer,
           vm::Message{{}, "", Command::kProp, "", "Error", vm::Relation::kAssign, "AutoOutput"},
           "");
  if (peer.clock.known) {
    const auto ignore = [](const Result<std::string>&) {};
    Forward(peer, vm::Set("Clock.mode", lockstep_ ? "HUB" : "REAL"), kHub, ignore);
    if (lockstep_) {
      AskClock(peer.key, clock_.Now(), ignore);  // from here on its clock is ours
    } else {
      MeasureClock(peer, kClockExchanges);
    }
  }
  FlushWaiting(peer);
  if (on_presence_) on_presence_(peer.name, true, "");
}

void Hub::FlushWaiting(Peer& peer) {
  auto waiting = std::exchange(peer.waiting, {});
  for (Pending& pending : waiting)
    Forward(peer, std::move(pending.request), pending.asker, std::move(pending.done));
}

void Hub::SampleClock(Peer& peer, vm::Time asked_at, const std::string& value) {
  const auto theirs = vm::ParseMs(value.substr(0, value.find(' ')));
  if (!theirs) return;
  peer.estimate.Add(asked_at, clock_.Now(), *theirs);
  peer.clock = {true, peer.estimate.offset(), peer.estimate.delay()};
}

void Hub::MeasureClock(Peer& peer, int exchanges) {
  if (exchanges <= 0) {
    if (std::exchange(peer.measuring, false)) FlushWaiting(peer);
    return;
  }
  Forward(
      peer, vm::Inq("Clock"), kHub,
      [this, key = peer.key, asked_at = clock_.Now(), exchanges](const Result<std::string>& value) {
        Peer* answering = ByKey(key);
        if (answering == nullptr) return;
        if (value) SampleClock(*answering, asked_at, *value);
        MeasureClock(*answering, value ? exchanges - 1 : 0);
      });
}

void Hub::MeasureClocks() {
  for (const PeerKey key : ModernModules()) MeasureClock(*ByKey(key), 2);
  if (++measurements_ % kRemoteEvery != 0) return;
  std::vector<PeerKey> remotes;
  for (const auto& [key, peer] : peers_) {
    if (peer->kind == PeerKind::kRemote && peer->asked_clock) remotes.push_back(key);
  }
  for (const PeerKey key : remotes) {
    if (Peer* peer = ByKey(key)) MeasureClock(*peer, 2);
  }
}

Hub::ClockState Hub::ClockOf(std::string_view name) const {
  const Peer* peer = Find(name);
  return peer == nullptr ? ClockState{} : peer->clock;
}

void Hub::EndProbes(const std::set<PeerKey>& modules) {
  for (const PeerKey key : modules) {
    Peer* peer = ByKey(key);
    if (peer == nullptr || !peer->probing) continue;
    // One that has said nothing at all yet may still be starting, on a busy machine.
    if (!peer->spoken && ++peer->silent_rounds < kSilentRounds) continue;
    Notice("@" + peer->name +
           " does not answer to Clock: it is spoken to as a module of the original");
    peer->probing = false;
    peer->dialect = Dialect::kOriginal;
    peer->pending.clear();
    FlushWaiting(*peer);
    if (on_presence_) on_presence_(peer->name, true, "");
  }
}

std::set<PeerKey> Hub::Probing() const {
  std::set<PeerKey> keys;
  for (const auto& [key, peer] : peers_) {
    if (peer->probing) keys.insert(key);
  }
  return keys;
}

std::vector<PeerKey> Hub::ModernModules() const {
  std::vector<PeerKey> keys;
  for (const auto& [key, peer] : peers_) {
    if (peer->kind == PeerKind::kModule && peer->dialect == Dialect::kModern && peer->clock.known)
      keys.push_back(key);
  }
  return keys;
}

void Hub::AskClock(PeerKey key, vm::Time grant, OnAnswer done) {
  Peer* peer = ByKey(key);
  if (peer == nullptr) return;
  const unsigned long number = ++last_tag_;
  Message request = vm::Set("Clock", vm::FormatMs(grant));
  peer->pending[number] = {kHub, request, std::move(done)};
  request.tag = HubTag(number);
  dirty_.erase(key);
  peer->granted = grant;
  Write(*peer, vm::FormatMessage(request));
}

}  // namespace am
