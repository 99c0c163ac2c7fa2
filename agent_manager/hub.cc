#include "agent_manager/hub.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "agent_manager/hub_peer.h"

namespace am {

using vm::Errc;
using vm::Error;
using vm::Fail;
using vm::Message;
using vm::Result;

namespace {

constexpr int kComplaintsPerSecond = 10;

}  // namespace

std::string HubTag(unsigned long number) { return "h" + std::to_string(number); }
unsigned long HubTagNumber(std::string_view tag) {
  unsigned long number = 0;
  if (tag.starts_with('h')) std::from_chars(tag.data() + 1, tag.data() + tag.size(), number);
  return number;
}

Hub::Hub(vm::Scheduler& clock, SessionLog& log) : clock_(clock), log_(log) {}
Hub::~Hub() = default;

Hub::Peer* Hub::ByKey(PeerKey key) {
  const auto found = peers_.find(key);
  return found == peers_.end() ? nullptr : found->second.get();
}
Hub::Peer* Hub::Find(std::string_view name) {
  const auto found = names_.find(name);
  return found == names_.end() ? nullptr : ByKey(found->second);
}
const Hub::Peer* Hub::Find(std::string_view name) const {
  const auto found = names_.find(name);
  return found == names_.end() ? nullptr : peers_.at(found->second).get();
}

void Hub::Notice(const std::string& text) const {
  if (on_notice_) on_notice_(text);
}

Result<PeerKey> Hub::Attach(std::unique_ptr<Link> link, PeerKind kind, const std::string& name,
                            Dialect dialect) {
  const PeerKey key = ++last_key_;
  const std::string full_name = name.empty() ? "CLIENT" + std::to_string(key) : name;
  if (peers_.size() >= limits_.peers) {
    link->Close();
    return Fail(Errc::kLimit, "more than " + std::to_string(limits_.peers) + " peers");
  }
  if (names_.contains(full_name) || internal_.contains(full_name)) {
    link->Close();
    return Fail(Errc::kBusy, "the name @" + full_name + " is taken");
  }
  auto peer = std::make_unique<Peer>();
  peer->key = key;
  peer->name = full_name;
  peer->kind = kind;
  peer->dialect = dialect;
  peer->link = std::move(link);
  if (kind == PeerKind::kConsole) peer->subscriptions = {"*"};
  Peer& attached = *peer;
  peers_.emplace(key, std::move(peer));
  names_.emplace(full_name, key);
  if (kind == PeerKind::kModule) {
    if (dialect == Dialect::kOriginal) {
      if (on_presence_) on_presence_(full_name, true, "");
    } else {
      Probe(attached);
    }
  }
  return key;
}

void Hub::Detach(PeerKey key, const std::string& reason) {
  const auto found = peers_.find(key);
  if (found == peers_.end()) return;
  const std::unique_ptr<Peer> peer = std::move(found->second);
  peers_.erase(found);
  names_.erase(peer->name);
  dirty_.erase(key);
  clock_.Cancel(peer->backlog_timer);
  ReleaseHeld(*peer);
  for (const auto& [slot, timer] : peer->held) {
    clock_.Cancel(timer);
    --held_;
  }
  peer->link->Close();
  const Error gone{Errc::kUnavailable, "@" + peer->name + " has gone (" + reason + ")", 0};
  const auto fail = [&](const Pending& pending) {
    clock_.Cancel(pending.limit);
    AnswerTo(pending.asker, peer->name, pending.request, std::unexpected(gone), pending.done);
  };
  for (const auto& [tag, pending] : peer->pending) fail(pending);
  for (const Pending& pending : peer->waiting) fail(pending);
  for (const auto& [slot, askers] : peer->asked) std::ranges::for_each(askers, fail);
  for (auto& [name, machine] : internal_) machine->PeerGone(key);
  if (on_presence_) on_presence_(peer->name, false, reason);
}

void Hub::AddInternal(vm::SlotMachine& machine, std::vector<std::string> aliases) {
  internal_[machine.module_name()] = &machine;
  for (std::string& alias : aliases) internal_[std::move(alias)] = &machine;
  machine.set_output([this, name = machine.module_name()](PeerKey to, const Message& said) {
    Message message = said;
    // Only our own questions are asked in nobody's name, so a peer's tag can never be taken for
    // one.
    if (const auto pending = internal_pending_.find(message.tag);
        to == vm::kEveryone && pending != internal_pending_.end()) {
      const OnAnswer done = std::move(pending->second.second);
      internal_pending_.erase(pending);
      const bool refused = message.slot.ends_with(".error");
      if (refused) {
        done(Fail(Errc::kUnavailable, message.value));
      } else {
        done(message.value);
      }
      return;
    }
    message.from = name;
    if (to != vm::kEveryone) {
      if (Peer* peer = ByKey(to)) Send(*peer, message);
      return;
    }
    std::set<PeerKey> receivers;
    for (const auto& [key, peer] : peers_) {
      if (peer->subscriptions.contains("*") || peer->subscriptions.contains(name))
        receivers.insert(key);
    }
    SendAll(receivers, message);
  });
}

void Hub::SendAll(const std::set<PeerKey>& receivers, const Message& message) {
  const std::string line = vm::FormatMessage(message);
  std::string names;
  for (const PeerKey key : receivers) {
    Peer* peer = ByKey(key);
    if (peer == nullptr) continue;
    Write(*peer, line);
    if (log_.enabled()) names += (names.empty() ? "" : ",") + peer->name;
  }
  if (log_.enabled()) log_.Write(clock_.Now(), message.from, names, line);
}

void Hub::Send(Peer& peer, const Message& message) {
  const std::string line = vm::FormatMessage(message);
  if (log_.enabled())
    log_.Write(clock_.Now(), message.from.empty() ? "AM" : message.from, peer.name, line);
  Write(peer, line);
}

void Hub::Complain(Peer& sender, const Error& error) {
  ++sender.traffic.refused;
  // A flood of bad lines must not become a flood of reports.
  if (clock_.Now() - sender.complaints_since > std::chrono::seconds(1)) {
    sender.complaints_since = clock_.Now();
    sender.complaints = 0;
  }
  if (++sender.complaints > kComplaintsPerSecond) return;
  Notice("@" + sender.name + ": " + vm::FormatError(error));
  if (sender.kind == PeerKind::kModule || sender.kind == PeerKind::kRemote) return;
  Message rep = vm::Rep("Error", vm::FormatError(error));
  rep.from = "AM";
  Send(sender, rep);
}

bool Hub::IsPresent(std::string_view name) const { return Find(name) != nullptr; }
bool Hub::IsModule(std::string_view name) const {
  const Peer* peer = Find(name);
  return peer != nullptr && peer->kind == PeerKind::kModule;
}
bool Hub::IsReady(std::string_view name) const {
  const Peer* peer = Find(name);
  return peer != nullptr && !peer->probing;
}

std::vector<std::string> Hub::Names() const {
  std::vector<std::string> names;
  for (const auto& [name, key] : names_) names.push_back(name);
  return names;
}

std::string Hub::NameOf(PeerKey key) const {
  const auto found = peers_.find(key);
  return found == peers_.end() ? "" : found->second->name;
}

Result<void> Hub::Rename(PeerKey key, const std::string& name) {
  Peer* peer = ByKey(key);
  if (peer == nullptr || peer->kind == PeerKind::kConsole)
    return Fail(Errc::kAccess, "only a client can take a name");
  if (!vm::IsModuleName(name))
    return Fail(Errc::kBadValue, "found '" + name + "', expected letters, digits, '_' or '-'");
  if (name == peer->name) return {};
  if (names_.contains(name) || internal_.contains(name) || reserved_.contains(name))
    return Fail(Errc::kBusy, "the name @" + name + " is taken");
  names_.erase(peer->name);
  names_[name] = key;
  peer->name = name;
  return {};
}

void Hub::Subscribe(PeerKey key, const std::set<std::string>& modules) {
  if (Peer* peer = ByKey(key)) peer->subscriptions = modules;
}

}  // namespace am
