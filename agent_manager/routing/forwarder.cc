#include "agent_manager/routing/forwarder.h"

#include <utility>

#include "agent_manager/routing/own_names.h"

namespace am {

using vm::Command;
using vm::Errc;
using vm::Message;
using vm::Result;

namespace {

/// True for what the hub itself asks in order to find out about a module.
bool IsProbe(const Message& message, const Origin& origin) {
  return origin.peer == kHub && (message.slot == "Clock" || message.slot == "Slots.files");
}

/// What is kept of a request until its answer comes. The value is not needed for that, and can be
/// 64 KiB long.
Message WithoutValue(const Message& message) {
  return {message.to, message.from, message.command, message.tag, message.slot, message.relation,
          ""};
}

}  // namespace

Forwarder::Forwarder(vm::Scheduler& clock, Directory& directory, Outbox& outbox, Requests& requests,
                     ClockGrants& grants, const AccessControl& access, const Limits& limits)
    : outbox_(outbox),
      requests_(requests),
      grants_(grants),
      limits_(limits),
      files_(clock, directory, access),
      starts_(clock, directory, limits,
              [this](Peer& module, const Message& start) { outbox_.Write(module, start, kHub); }) {}

bool Forwarder::MustWait(Peer& peer, const Message& message, const Origin& origin) {
  if (peer.probe.probing) return true;
  if (IsProbe(message, origin)) return false;
  if (peer.probe.measuring) return true;
  if (files_.MustAsk(peer, origin.role)) {
    files_.AskSlots(
        peer,
        [this](Peer& asked, Message question, OnAnswer done) {
          Forward(asked, std::move(question), Origin::OfHub(), std::move(done));
        },
        [this](Peer& known) { FlushWaiting(known); });
    return true;
  }
  return peer.kind == PeerKind::kRemote && StartTimeOf(message) && clock_wanted_(peer);
}

void Forwarder::KeepWaiting(Peer& peer, Message message, const Origin& origin, OnAnswer done) {
  WaitingList& waiting = peer.waiting;
  if (waiting.messages.size() >= limits_.waiting ||
      waiting.bytes + message.value.size() > limits_.backlog_bytes)
    return outbox_.Answer(
        origin.peer, peer.name, message,
        vm::Fail(Errc::kLimit, "@" + peer.name + " is still being asked, too much waits for it"),
        done);
  requests_.CountUnanswered(origin.peer);
  waiting.bytes += message.value.size();
  waiting.messages.push_back({std::move(message), origin, std::move(done)});
}

void Forwarder::Forward(Peer& peer, Message message, const Origin& origin, OnAnswer done) {
  if (MustWait(peer, message, origin))
    return KeepWaiting(peer, std::move(message), origin, std::move(done));
  if (const auto checked = files_.Check(peer, message, origin.role); !checked)
    return outbox_.Answer(origin.peer, own_name::kHub, message, std::unexpected(checked.error()),
                          done);
  if (peer.dialect == Dialect::kOriginal)
    return ForwardOriginal(peer, std::move(message), origin, done);
  const bool modern = peer.dialect == Dialect::kModern;
  if (!modern && message.tag.empty() && !done && message.command != Command::kInq)
    return outbox_.Write(peer, message, origin.peer);
  if (modern && !peer.probe.clock.known && starts_.Hold(peer, message))
    return outbox_.Answer(origin.peer, peer.name, message, message.value, done);
  Request request{origin.peer, WithoutValue(message), std::move(done), vm::Time(0)};
  if (const auto start = modern ? StartTimeOf(message) : std::nullopt)
    message.value =
        "@" + vm::FormatMs(*start + (grants_.lockstep() ? vm::Time(0) : peer.probe.clock.offset));
  message.tag = requests_.Add(peer, std::move(request));
  outbox_.Write(peer, message, origin.peer);
}

void Forwarder::FlushWaiting(Peer& peer) {
  peer.waiting.bytes = 0;
  for (WaitingMessage& waiting : std::exchange(peer.waiting.messages, {})) {
    requests_.UncountUnanswered(waiting.origin.peer);
    Forward(peer, std::move(waiting.message), waiting.origin, std::move(waiting.done));
  }
}

void Forwarder::ForwardOriginal(Peer& module, Message message, const Origin& origin,
                                const OnAnswer& done) {
  // It knows neither tags nor errors: a question is paired with the next report of that slot,
  // anything else counts as done when it is sent.
  Message bare = message;
  bare.tag.clear();
  if (message.command == Command::kInq) {
    requests_.AddBySlot(module, {origin.peer, WithoutValue(message), done, vm::Time(0)});
    return outbox_.Write(module, bare, origin.peer);
  }
  if (!starts_.Hold(module, message)) outbox_.Write(module, bare, origin.peer);
  outbox_.Answer(origin.peer, module.name, message, message.value, done);
}

void Forwarder::Forget(Peer& peer) {
  grants_.Forget(peer);
  files_.Forget(peer);
  starts_.Forget(peer);
  const vm::Error gone{Errc::kUnavailable, "@" + peer.name + " has gone", 0};
  for (const WaitingMessage& waiting : std::exchange(peer.waiting.messages, {})) {
    requests_.UncountUnanswered(waiting.origin.peer);
    outbox_.Answer(waiting.origin.peer, peer.name, waiting.message, std::unexpected(gone),
                   waiting.done);
  }
}

}  // namespace am
