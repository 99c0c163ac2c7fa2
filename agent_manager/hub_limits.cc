// What each peer may do to the others: floods are read slower, slow readers stand alone.

#include <algorithm>
#include <utility>

#include "agent_manager/hub.h"
#include "agent_manager/hub_peer.h"

namespace am {

using vm::Errc;

namespace {

constexpr vm::Time kLookAgain = std::chrono::milliseconds(10);  // at a reader that is full

}  // namespace

void Hub::Write(Peer& peer, std::string_view line) {
  ++peer.traffic.messages_out;
  peer.traffic.bytes_out += line.size() + 1;
  peer.link->Send(line);
  const std::size_t backlog = peer.link->backlog_bytes();
  if (backlog > limits_.backlog_bytes / 2) OnBacklog(peer, backlog);
}

bool Hub::SendUnlogged(PeerKey key, std::string_view line) {
  Peer* peer = ByKey(key);
  if (peer == nullptr || peer->cut_off) return false;
  const bool commanded = std::exchange(commanding_, false);  // an onlooker holds nobody
  Write(*peer, line);
  commanding_ = commanded;
  return true;
}

void Hub::OnBacklog(Peer& peer, std::size_t backlog) {
  if (backlog > limits_.backlog_bytes)
    return CutOff(peer, "more than " + std::to_string(limits_.backlog_bytes) +
                            " bytes wait for it: it does not read fast enough");
  // Who speaks to it waits for it, and nobody else. Modules' reports hold nobody back: a module
  // has many hearers, and one of them must not stop it for the others.
  Peer* const sender = commanding_ ? ByKey(speaking_) : nullptr;
  if (sender == nullptr || sender->key == peer.key || lockstep_) return;
  if (!peer.holds.insert(sender->key).second) return;
  ++sender->traffic.held;
  if (++sender->held_by == 1) sender->link->PauseReading();
  if (peer.holds.size() > 1) return;
  peer.full_since = clock_.Now();
  peer.least_backlog = backlog;
  WatchBacklog(peer);
}

void Hub::WatchBacklog(Peer& peer) {
  peer.backlog_timer = clock_.After(kLookAgain, [this, key = peer.key] {
    Peer* full = ByKey(key);
    if (full == nullptr) return;
    full->backlog_timer = 0;
    const std::size_t backlog = full->link->backlog_bytes();
    if (backlog <= limits_.backlog_bytes / 4) return ReleaseHeld(*full);
    if (backlog < full->least_backlog) {
      full->least_backlog = backlog;
      full->full_since = clock_.Now();
    }
    if (clock_.Now() - full->full_since >= std::chrono::milliseconds(limits_.stall_ms))
      return CutOff(*full, "it has read nothing for " + std::to_string(limits_.stall_ms) +
                               " ms while others wait for it");
    WatchBacklog(*full);
  });
}

void Hub::ReleaseHeld(Peer& peer) {
  for (const PeerKey key : std::exchange(peer.holds, {})) {
    Peer* sender = ByKey(key);
    if (sender != nullptr && --sender->held_by == 0) sender->link->ResumeReading();
  }
}

void Hub::CutOff(Peer& peer, const std::string& why) {
  if (peer.cut_off) return;
  peer.cut_off = true;
  Notice("@" + peer.name + ": " + why + ", it is cut off");
  // Later: a line for it is on its way somewhere above us.
  clock_.Post([this, key = peer.key, why] {
    Peer* slow = ByKey(key);
    if (slow == nullptr) return;
    slow->link->Close();
    if (on_cut_off_) on_cut_off_(key, why);
    Detach(key, why);
  });
}

void Hub::Throttle(Peer& peer, std::size_t bytes) {
  if (lockstep_ || (limits_.messages_per_s == 0 && limits_.bytes_per_s == 0)) return;
  // What the hub itself reads for its owner, and its own modules' reports, are trusted as much as
  // any other peer: a module that has gone wild is held, too.
  const vm::Time now = clock_.Now();
  const vm::Time wait =
      std::max(peer.messages.Take(1, limits_.messages_per_s, now),
               peer.bytes.Take(static_cast<double>(bytes), limits_.bytes_per_s, now));
  if (wait <= vm::Time(0) || peer.throttled) return;
  peer.throttled = true;
  ++peer.traffic.throttled;
  if (++peer.held_by == 1) peer.link->PauseReading();
  clock_.After(wait, [this, key = peer.key] {
    Peer* held = ByKey(key);
    if (held == nullptr) return;
    held->throttled = false;
    if (--held->held_by == 0) held->link->ResumeReading();
  });
}

vm::Result<void> Hub::CountDefinition(PeerKey key, const vm::Message& message) {
  Peer* peer = ByKey(key);
  if (peer == nullptr) return {};
  if (message.command == vm::Command::kDel) {
    peer->defined.erase(message.slot);
    return {};
  }
  if (message.command != vm::Command::kDef || peer->defined.contains(message.slot)) return {};
  if (peer->defined.size() >= limits_.slots)
    return vm::Fail(Errc::kLimit, "@" + peer->name + " has already defined " +
                                      std::to_string(limits_.slots) + " slots");
  peer->defined.insert(message.slot);
  return {};
}

std::vector<PeerStatus> Hub::Status() const {
  std::vector<PeerStatus> all;
  for (const auto& [key, peer] : peers_) {
    all.push_back({peer->name, peer->kind, peer->traffic, peer->link->backlog_bytes(),
                   peer->pending.size() + peer->waiting.size(), peer->defined.size(),
                   peer->held_by > 0});
  }
  return all;
}

}  // namespace am
