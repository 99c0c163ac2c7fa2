#include "agent_manager/routing/module_lines.h"

#include <optional>
#include <utility>

#include "vm_protocol/core/start_time.h"

namespace am {

using vm::Command;
using vm::Errc;
using vm::Fail;
using vm::Message;
using vm::Result;

namespace {

constexpr vm::Time kFilesLimit = std::chrono::seconds(2);  // for a module to name its file slots

/// The instant of `set SLOT = @T`.
std::optional<vm::Time> StartTimeOf(const Message& message) {
  if (message.command != Command::kSet || !message.value.starts_with('@')) return std::nullopt;
  const auto start = vm::ParseStartTime(message.value);
  if (!start || start->kind != vm::StartTime::Kind::kAt) return std::nullopt;
  return start->time;
}

/// True for what the hub itself asks to find out about a module.
bool IsOfTheHub(const Message& message, const Origin& origin) {
  return origin.peer == kHub && (message.slot == "Clock" || message.slot == "Slots.files");
}

}  // namespace

ModuleLines::ModuleLines(vm::Scheduler& clock, Directory& directory, Outbox& outbox,
                         Requests& requests, const AccessControl& access, const Limits& limits)
    : clock_(clock),
      directory_(directory),
      outbox_(outbox),
      requests_(requests),
      access_(access),
      limits_(limits) {}

bool ModuleLines::MustWait(Peer& peer, const Message& message, const Origin& origin) {
  ModuleState& module = peer.module;
  if (module.probing) return true;
  if (IsOfTheHub(message, origin)) return false;
  if (module.measuring) return true;
  if (!access_.AllFiles(origin.role) && !module.files && peer.dialect == Dialect::kModern &&
      peer.kind == PeerKind::kModule) {
    if (module.files_timer == 0) AskFiles(peer);
    return true;
  }
  if (peer.kind != PeerKind::kRemote || module.asked_clock || !StartTimeOf(message)) return false;
  module.asked_clock = module.measuring = true;
  clock_needed_(peer.key);
  return true;
}

void ModuleLines::AskFiles(Peer& peer) {
  const auto learn = [this, key = peer.key](const Result<std::string>& declared) {
    Peer* const module = directory_.ByKey(key);
    if (module == nullptr || module->module.files) return;
    clock_.Cancel(std::exchange(module->module.files_timer, 0));
    --held_;
    module->module.files = declared ? FileSlots(*declared) : FileSlots();
    FlushWaiting(*module);
  };
  ++held_;
  peer.module.files_timer = clock_.After(kFilesLimit, [learn] { learn(Fail(Errc::kTimeout, "")); });
  Forward(peer, vm::Inq("Slots.files"), Origin{}, learn);
}

Result<void> ModuleLines::CheckFiles(const Peer& peer, const Message& message, Role role) const {
  static const FileSlots kUndeclared;
  if (message.command == Command::kDef && message.relation == vm::Relation::kAppend) {
    const auto kept = vm::ParseMessage(message.value);
    return kept ? CheckFiles(peer, *kept, role) : Result<void>();
  }
  const bool unseen =
      message.command == Command::kDo ||
      (message.command == Command::kDef && message.relation == vm::Relation::kFromFile);
  if (unseen) return access_.CheckUnseenLines(role, peer.name);
  return access_.CheckFiles(role, message, peer.module.files ? *peer.module.files : kUndeclared,
                            peer.folder);
}

void ModuleLines::Forward(Peer& peer, Message message, const Origin& origin, OnAnswer done) {
  if (MustWait(peer, message, origin)) {
    if (peer.module.waiting.size() >= limits_.waiting) {
      return outbox_.Answer(
          origin.peer, peer.name, message,
          Fail(Errc::kLimit, "@" + peer.name + " is still being asked, too much waits for it"),
          done);
    }
    requests_.Count(origin.peer);
    peer.module.waiting.push_back({std::move(message), origin, std::move(done)});
    return;
  }
  if (!access_.AllFiles(origin.role) && message.command != Command::kRep) {
    if (const auto checked = CheckFiles(peer, message, origin.role); !checked)
      return outbox_.Answer(origin.peer, "AM", message, std::unexpected(checked.error()), done);
  }
  if (peer.dialect == Dialect::kOriginal)
    return ForwardOriginal(peer, std::move(message), origin, done);
  const bool modern = peer.dialect == Dialect::kModern;
  if (!modern && message.tag.empty() && !done && message.command != Command::kInq)
    return SendBare(peer, std::move(message), origin.peer);
  if (modern && !peer.module.clock.known && HoldStart(peer, message))
    return outbox_.Answer(origin.peer, peer.name, message, message.value, done);
  Request request{origin.peer, message, std::move(done), vm::Time(0)};
  if (const auto start = modern ? StartTimeOf(message) : std::nullopt)
    message.value =
        "@" + vm::FormatMs(*start + (lockstep_ ? vm::Time(0) : peer.module.clock.offset));
  message.tag = requests_.Add(peer, std::move(request));
  SendBare(peer, std::move(message), origin.peer);
}

void ModuleLines::FlushWaiting(Peer& peer) {
  for (Held& held : std::exchange(peer.module.waiting, {})) {
    requests_.Uncount(held.origin.peer);
    Forward(peer, std::move(held.message), held.origin, std::move(held.done));
  }
}

void ModuleLines::SendBare(Peer& module, Message message, PeerKey commander) {
  if (lockstep_ && module.module.clock.known && module.module.granted < clock_.Now()) {
    // Nothing may reach a module before its clock stands where ours does.
    Grant(module, clock_.Now(), [](const Result<std::string>&) {});
  }
  if (module.module.clock.known) dirty_.insert(module.key);
  outbox_.Write(module, message, commander);
}

void ModuleLines::ForwardOriginal(Peer& module, Message message, const Origin& origin,
                                  const OnAnswer& done) {
  // It knows neither tags nor errors: a question is paired with the next report of that slot,
  // anything else counts as done when it is sent.
  Message bare = message;
  bare.tag.clear();
  if (message.command == Command::kInq) {
    requests_.AddBySlot(module, {origin.peer, std::move(message), done, vm::Time(0)});
    return SendBare(module, std::move(bare), origin.peer);
  }
  if (!HoldStart(module, message)) SendBare(module, std::move(bare), origin.peer);
  outbox_.Answer(origin.peer, module.name, message, message.value, done);
}

bool ModuleLines::HoldStart(Peer& module, const Message& message) {
  if (message.command != Command::kSet) return false;
  auto& held = module.module.held_starts;
  if (const auto before = held.find(message.slot); before != held.end()) {
    clock_.Cancel(before->second);  // STOP, or a new start, takes the place of the one held
    held.erase(before);
    --held_;
  }
  const auto start = StartTimeOf(message);
  if (!start || held.size() >= limits_.pending) return false;
  ++held_;
  held[message.slot] = clock_.At(*start, [this, key = module.key, slot = message.slot] {
    Peer* const peer = directory_.ByKey(key);
    if (peer == nullptr) return;
    peer->module.held_starts.erase(slot);
    --held_;
    SendBare(*peer, vm::Set(slot, "NOW"), kHub);
  });
  return true;
}

void ModuleLines::Grant(Peer& module, vm::Time until, OnAnswer done) {
  Message request = vm::Set("Clock", vm::FormatMs(until));
  dirty_.erase(module.key);
  module.module.granted = until;
  request.tag = requests_.Add(module, {kHub, request, std::move(done), vm::Time(0)});
  outbox_.Write(module, request, kHub);
}

void ModuleLines::Forget(Peer& peer) {
  dirty_.erase(peer.key);
  if (peer.module.files_timer != 0) {
    clock_.Cancel(peer.module.files_timer);
    --held_;
  }
  for (const auto& [slot, timer] : peer.module.held_starts) {
    clock_.Cancel(timer);
    --held_;
  }
  const vm::Error gone{Errc::kUnavailable, "@" + peer.name + " has gone", 0};
  for (const Held& held : std::exchange(peer.module.waiting, {})) {
    requests_.Uncount(held.origin.peer);
    outbox_.Answer(held.origin.peer, peer.name, held.message, std::unexpected(gone), held.done);
  }
}

}  // namespace am
