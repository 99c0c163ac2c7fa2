#include "agent_manager/routing/router.h"

#include <utility>
#include <vector>

#include "agent_manager/routing/own_names.h"
#include "vm_protocol/core/nearest_word.h"

namespace am {

using vm::Command;
using vm::Errc;
using vm::Fail;
using vm::Message;
using vm::Result;

namespace {

bool IsReport(const Message& message) {
  return message.command == Command::kRep || message.command == Command::kTell;
}

/// About what a message takes while it is kept.
std::size_t BytesOf(const Message& message) {
  return sizeof(Envelope) + message.value.size() + message.slot.size();
}

}  // namespace

Router::Router(vm::Scheduler& clock, SessionLog& log, Directory& directory, Outbox& outbox,
               Requests& requests, Forwarder& forwarder, WorkQueue& queue,
               const AccessControl& access, const Limits& limits)
    : clock_(clock),
      log_(log),
      directory_(directory),
      outbox_(outbox),
      requests_(requests),
      forwarder_(forwarder),
      queue_(queue),
      access_(access),
      limits_(limits),
      questions_(queue, limits) {}

std::string Router::SenderOf(const Envelope& envelope) const {
  if (!envelope.machine.empty()) return envelope.machine;
  const Peer* const peer = directory_.ByKey(envelope.origin.peer);
  return peer == nullptr ? own_name::kHub : peer->name;
}

Rules::Sender Router::RuleSenderOf(const Envelope& envelope) const {
  const Peer* const starter = directory_.ByKey(envelope.origin.peer);
  return {SenderOf(envelope), starter == nullptr ? "" : starter->name, envelope.origin.role,
          envelope.machine.empty() ? envelope.origin.peer : kHub};
}

void Router::Refuse(const Envelope& envelope, const vm::Error& error, const std::string& by) {
  const PeerKey asker = envelope.machine.empty() ? envelope.origin.peer : kHub;
  outbox_.Answer(asker, by, envelope.message, std::unexpected(error), envelope.done);
}

void Router::Route(Envelope& envelope) {
  if (envelope.machine.empty()) {
    Peer* const sender = directory_.ByKey(envelope.origin.peer);
    if (sender == nullptr) return;  // gone: what it asked for nobody waits for
    if (IsReport(envelope.message)) {
      const auto checked = access_.CheckMessage(sender->role, "", envelope.message);
      if (!checked) return outbox_.Complain(*sender, checked.error(), envelope.message.tag);
      return RouteReport(*sender, std::move(envelope.message));
    }
  }
  if (envelope.origin.depth > kMaxOriginDepth)
    return Refuse(envelope, {Errc::kLimit,
                             "macros have started each other more than " +
                                 std::to_string(kMaxOriginDepth) + " times without a pause",
                             0});
  std::vector<std::string> receivers = std::exchange(envelope.message.to, {});
  if (receivers.empty()) receivers.emplace_back(own_name::kHub);
  for (std::size_t i = 0; i + 1 < receivers.size(); ++i) {
    Envelope copy = envelope;
    RouteTo(receivers[i], copy);
  }
  RouteTo(receivers.back(), envelope);
}

void Router::RouteTo(std::string& receiver, Envelope& envelope) {
  if (const vm::SlotMachine* const machine = directory_.Machine(receiver);
      machine != nullptr && machine->module_name() != receiver)
    receiver = machine->module_name();  // not one of its other names: rules and rights know one
  if (envelope.origin.role != Role::kOwner) {
    const auto checked = access_.CheckMessage(envelope.origin.role, receiver, envelope.message);
    if (!checked) return Refuse(envelope, checked.error());
  }
  if (rules_.empty()) return HandOver(envelope, receiver);
  ApplyRules(envelope, receiver);
}

void Router::ApplyRules(Envelope& envelope, std::string& receiver) {
  const Rules::Sender sender = RuleSenderOf(envelope);
  const Rules::Outcome outcome = rules_.Apply(sender, receiver, envelope.message, clock_.Now());
  SendCopies(outcome, sender.name, envelope.origin.role);
  if (outcome.dropped) {
    // Nobody waits for an answer that never comes; a sender that did not ask for one hears nothing.
    if (envelope.done || !envelope.message.tag.empty())
      Refuse(envelope, {Errc::kAccess, *outcome.dropped, 0});
    return;
  }
  if (outcome.delay <= vm::Time(0)) return HandOver(envelope, receiver);
  const auto delayed = std::make_shared<Envelope>(std::move(envelope));
  const auto kept = Delay(
      outcome.delay, [this, delayed, receiver] { HandOver(*delayed, receiver); },
      delayed->origin.peer, BytesOf(delayed->message));
  if (!kept) Refuse(*delayed, kept.error());
}

Result<void> Router::Delay(vm::Time delay, std::function<void()> act, PeerKey sender,
                           std::size_t bytes) {
  Peer* const peer = directory_.ByKey(sender);
  const std::size_t own = peer == nullptr ? 0 : peer->delayed_bytes;
  if (own + bytes > limits_.backlog_bytes ||
      delayed_bytes_ + bytes > limits_.backlog_bytes * kDelayShares)
    return Fail(Errc::kLimit, "too much is delayed by rules already");
  ++delayed_;
  delayed_bytes_ += bytes;
  if (peer != nullptr) peer->delayed_bytes += bytes;
  clock_.After(delay, [this, act = std::move(act), sender, bytes] {
    --delayed_;
    delayed_bytes_ -= bytes;
    if (Peer* const there = directory_.ByKey(sender)) there->delayed_bytes -= bytes;
    queue_.Post(act, sender);
  });
  return {};
}

void Router::SendCopies(const Rules::Outcome& outcome, const std::string& from, Role role) {
  for (const std::string& note : outcome.notes) outbox_.Notice(note);
  for (const auto& [receiver, copy] : outcome.copies) {
    Peer* const peer = directory_.Find(receiver);
    if (peer == nullptr) continue;
    Message message = copy;
    message.to.clear();
    message.tag.clear();
    if (IsReport(copy)) {
      message.from = from;
      outbox_.Send(*peer, message, kHub);
      continue;
    }
    message.from.clear();
    // Nobody hears the answer to a copy, but the files it names are the sender's wish.
    forwarder_.Forward(*peer, std::move(message), {.peer = kHub, .role = role}, nullptr);
  }
}

void Router::LogTo(const Envelope& envelope, const std::string& receiver) {
  if (!log_.enabled()) return;
  std::string sender = SenderOf(envelope);
  if (envelope.machine.empty() && envelope.origin.lines_left) sender += LogEntry::kByScript;
  log_.Write(clock_.Now(), sender, receiver, vm::FormatMessage(vm::To(receiver, envelope.message)));
}

void Router::HandOver(Envelope& envelope, const std::string& receiver) {
  envelope.message.from.clear();
  if (Peer* const peer = directory_.Find(receiver)) {
    LogTo(envelope, receiver);
    // A macro's own requests are answered to the macro, whoever started it.
    Origin origin = envelope.origin;
    if (!envelope.machine.empty()) origin.peer = kHub;
    return forwarder_.Forward(*peer, std::move(envelope.message), origin, std::move(envelope.done));
  }
  if (vm::SlotMachine* const machine = directory_.Machine(receiver)) {
    LogTo(envelope, receiver);
    return ToMachine(*machine, envelope);
  }
  const Result<bool> attached =
      on_unknown_ ? on_unknown_(receiver, envelope.origin.role) : Result<bool>(false);
  if (!attached) return Refuse(envelope, attached.error());
  if (*attached && directory_.Find(receiver) != nullptr) return HandOver(envelope, receiver);
  // Whoever may not know who there is gets no hints.
  const std::string meant = envelope.origin.role == Role::kOwner
                                ? vm::DidYouMean(receiver, directory_.Addressable())
                                : std::string();
  Refuse(envelope, {Errc::kUnknownModule,
                    "there is no @" + receiver + " (inq Modules lists them)" + meant, 0});
}

void Router::ToMachine(vm::SlotMachine& machine, Envelope& envelope) {
  if (const auto counted = CountDefinition(envelope); !counted)
    return Refuse(envelope, counted.error(), machine.module_name());
  const PeerKey asker = envelope.machine.empty() ? envelope.origin.peer : kHub;
  if (envelope.done) envelope.message.tag = questions_.Add(std::move(envelope.done));
  const Result<Taken> taken = on_machine_ ? on_machine_(machine, envelope) : Result<Taken>(Taken{});
  if (taken && !taken->taken) return machine.Handle(envelope.message, asker);
  if (taken && (!taken->answer || envelope.message.tag.empty())) return;
  const std::string slot = SlotOf(envelope.message);
  Message answer = taken ? vm::Rep(slot, *taken->answer)
                         : vm::Rep(slot + ".error", vm::FormatError(taken.error()));
  answer.tag = envelope.message.tag;
  if (asker != kHub || !answer.tag.empty()) FromMachine(machine.module_name(), asker, answer);
}

void Router::FromMachine(const std::string& machine, PeerKey to, const Message& said) {
  // Only our own questions are asked in nobody's name, so a peer's tag is never taken for one.
  if (to == kHub && !said.tag.empty()) return questions_.Resolve(said);
  Message message = said;
  message.from = machine;
  if (to == kHub) return ReportOf(machine, std::move(message));
  if (Peer* const peer = directory_.ByKey(to)) outbox_.Send(*peer, message, kHub);
}

void Router::ReportOf(const std::string& machine, Message message) {
  std::set<PeerKey> receivers;
  for (const auto& [key, peer] : directory_.peers()) {
    if (peer->subscriptions.contains("*") || peer->subscriptions.contains(machine))
      receivers.insert(key);
  }
  outbox_.SendAll(receivers, message, kHub);
}

Result<void> Router::CountDefinition(const Envelope& envelope) {
  Peer* const peer = directory_.ByKey(envelope.origin.peer);
  const Message& message = envelope.message;
  if (peer == nullptr) return {};
  if (message.command == Command::kDel) {
    peer->defined.erase(message.slot);
    return {};
  }
  if (message.command != Command::kDef || peer->defined.contains(message.slot)) return {};
  if (peer->defined.size() >= limits_.slots)
    return Fail(Errc::kLimit, "@" + peer->name + " has already defined " +
                                  std::to_string(limits_.slots) + " slots");
  peer->defined.insert(message.slot);
  return {};
}

void Router::RouteReport(Peer& sender, Message message) {
  if (message.command == Command::kRep && requests_.Resolve(sender, message)) return;
  for (const std::string& name : message.to) {
    if (const auto checked = access_.CheckReceiver(sender.role, name); !checked)
      return outbox_.Complain(sender, checked.error(), message.tag);
  }
  if (sender.kind == PeerKind::kClient && message.slot == "Run" && message.value == "LIVE") {
    sender.kind = PeerKind::kModule;  // a module that came by a socket
    if (on_module_) on_module_(sender);
  }
  if (rules_.empty()) return Spread(sender, std::move(message));
  if (message.to.empty()) return ApplyRulesToReport(sender, std::move(message));
  for (const std::string& name : message.to) {  // a rule is for one receiver
    Message copy = message;
    copy.to = {name};
    ApplyRulesToReport(sender, std::move(copy));
  }
}

void Router::ApplyRulesToReport(Peer& sender, Message message) {
  std::string to = message.to.size() == 1 ? message.to.front() : "";
  const std::string before = to;
  const Rules::Outcome outcome =
      rules_.Apply({sender.name, "", sender.role, sender.key}, to, message, clock_.Now());
  SendCopies(outcome, sender.name, sender.role);
  if (outcome.dropped) return;
  if (to != before) message.to = {to};
  if (outcome.delay <= vm::Time(0)) return Spread(sender, std::move(message));
  const PeerKey key = sender.key;
  const std::size_t bytes = BytesOf(message);
  const auto kept = Delay(
      outcome.delay,
      [this, key, message = std::move(message)] {
        if (Peer* const peer = directory_.ByKey(key)) Spread(*peer, message);
      },
      key, bytes);
  if (!kept) outbox_.Complain(sender, kept.error());
}

std::set<PeerKey> Router::HearersOf(const Peer& sender) {
  std::set<PeerKey> hearers;
  for (const auto& [key, peer] : directory_.peers()) {
    const bool broadcast = sender.kind != PeerKind::kRemote && broadcast_.contains(peer->name);
    if (key != sender.key && (broadcast || peer->subscriptions.contains("*") ||
                              peer->subscriptions.contains(sender.name)))
      hearers.insert(key);
  }
  return hearers;
}

void Router::Spread(Peer& sender, Message message) {
  std::set<PeerKey> receivers;
  if (message.to.empty()) receivers = HearersOf(sender);
  for (const std::string& name : std::exchange(message.to, {})) {
    if (const Peer* const peer = directory_.Find(name)) {
      receivers.insert(peer->key);
    } else if (directory_.Machine(name) == nullptr) {
      outbox_.Complain(sender, {Errc::kUnknownModule, "there is no @" + name, 0});
    }
  }
  for (const Request& request : requests_.TakeBySlot(sender, message.slot)) {
    if (request.message.tag.empty() && !request.done) {
      receivers.insert(request.asker);
    } else {
      outbox_.Answer(request.asker, sender.name, request.message, message.value, request.done);
    }
  }
  message.from = sender.name;
  outbox_.SendAll(receivers, message, WaitsForHearers(sender));
  if (on_report_) on_report_(sender.name, message);
}

}  // namespace am
