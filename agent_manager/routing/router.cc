#include "agent_manager/routing/router.h"

#include <charconv>
#include <utility>
#include <vector>

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

/// Tags of what the hub's parts ask of its own machines: "i" and a number.
unsigned long NumberOf(std::string_view tag) {
  unsigned long number = 0;
  if (tag.starts_with('i')) std::from_chars(tag.data() + 1, tag.data() + tag.size(), number);
  return number;
}

}  // namespace

Router::Router(vm::Scheduler& clock, SessionLog& log, Directory& directory, Outbox& outbox,
               Requests& requests, ModuleLines& lines, WorkQueue& queue,
               const AccessControl& access, const Limits& limits)
    : clock_(clock),
      log_(log),
      directory_(directory),
      outbox_(outbox),
      requests_(requests),
      lines_(lines),
      queue_(queue),
      access_(access),
      limits_(limits) {}

std::string Router::SenderOf(const Envelope& envelope) const {
  if (!envelope.machine.empty()) return envelope.machine;
  const Peer* const peer = directory_.ByKey(envelope.origin.peer);
  return peer == nullptr ? "AM" : peer->name;
}

Rules::Sender Router::RuleSenderOf(const Envelope& envelope) const {
  const Peer* const starter = directory_.ByKey(envelope.origin.peer);
  return {SenderOf(envelope), starter == nullptr ? "" : starter->name, envelope.origin.role};
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
      return Report(*sender, std::move(envelope.message));
    }
  }
  if (envelope.origin.depth > kMaxOriginDepth)
    return Refuse(envelope, {Errc::kLimit,
                             "macros have started each other more than " +
                                 std::to_string(kMaxOriginDepth) + " times without a pause",
                             0});
  std::vector<std::string> receivers = std::exchange(envelope.message.to, {});
  if (receivers.empty()) receivers.emplace_back("AM");
  for (std::size_t i = 0; i + 1 < receivers.size(); ++i) {
    Envelope copy = envelope;
    Deliver(copy, receivers[i]);
  }
  Deliver(envelope, receivers.back());
}

void Router::Deliver(Envelope& envelope, std::string& receiver) {
  if (const vm::SlotMachine* const machine = directory_.Machine(receiver);
      machine != nullptr && machine->module_name() != receiver)
    receiver = machine->module_name();  // not one of its other names: rules and rights know one
  if (envelope.origin.role != Role::kOwner) {
    const auto checked = access_.CheckMessage(envelope.origin.role, receiver, envelope.message);
    if (!checked) return Refuse(envelope, checked.error());
  }
  if (rules_.empty()) return DeliverNow(envelope, receiver);
  DeliverByRule(envelope, receiver);
}

void Router::DeliverByRule(Envelope& envelope, std::string& receiver) {
  const Rules::Sender sender = RuleSenderOf(envelope);
  const Rules::Outcome outcome = rules_.Apply(sender, receiver, envelope.message, clock_.Now());
  CarryOut(outcome, sender.name);
  if (outcome.dropped) {
    // Nobody waits for an answer that never comes; who did not ask for one hears nothing.
    if (envelope.done || !envelope.message.tag.empty())
      Refuse(envelope, {Errc::kAccess, *outcome.dropped, 0});
    return;
  }
  if (outcome.delay <= vm::Time(0)) return DeliverNow(envelope, receiver);
  lines_.CountHeld(1);
  const auto held = std::make_shared<Envelope>(std::move(envelope));
  clock_.After(outcome.delay, [this, held, receiver] {
    lines_.CountHeld(-1);
    queue_.Post([this, held, receiver] { DeliverNow(*held, receiver); }, held->origin.peer);
  });
}

void Router::CarryOut(const Rules::Outcome& outcome, const std::string& from) {
  for (const std::string& note : outcome.notes) outbox_.Notice(note);
  for (const auto& [receiver, copy] : outcome.copies) {
    Peer* const peer = directory_.Find(receiver);
    if (peer == nullptr) continue;
    Message message = copy;
    message.to.clear();
    message.tag.clear();
    if (!IsReport(copy)) {
      message.from.clear();
      lines_.Forward(*peer, std::move(message), {}, nullptr);
      continue;
    }
    message.from = from;
    outbox_.Send(*peer, message, kHub);
  }
}

void Router::LogTo(const Envelope& envelope, const std::string& receiver) {
  if (!log_.enabled()) return;
  log_.Write(clock_.Now(), SenderOf(envelope), receiver,
             vm::FormatMessage(vm::To(receiver, envelope.message)));
}

void Router::DeliverNow(Envelope& envelope, const std::string& receiver) {
  envelope.message.from.clear();
  if (Peer* const peer = directory_.Find(receiver)) {
    LogTo(envelope, receiver);
    // A macro's own requests are answered to the macro, whoever started it.
    Origin origin = envelope.origin;
    if (!envelope.machine.empty()) origin.peer = kHub;
    return lines_.Forward(*peer, std::move(envelope.message), origin, std::move(envelope.done));
  }
  if (vm::SlotMachine* const machine = directory_.Machine(receiver)) {
    LogTo(envelope, receiver);
    return ToMachine(*machine, envelope);
  }
  const Result<bool> attached = on_unknown_ ? on_unknown_(receiver) : Result<bool>(false);
  if (!attached) return Refuse(envelope, attached.error());
  if (*attached && directory_.Find(receiver) != nullptr) return DeliverNow(envelope, receiver);
  Refuse(envelope,
         {Errc::kUnknownModule, "there is no @" + receiver + " (inq Modules lists them)", 0});
}

void Router::ToMachine(vm::SlotMachine& machine, Envelope& envelope) {
  if (const auto counted = CountDefinition(envelope); !counted)
    return Refuse(envelope, counted.error(), machine.module_name());
  const PeerKey asker = envelope.machine.empty() ? envelope.origin.peer : kHub;
  if (envelope.done) {
    if (asked_of_machines_.size() >= limits_.pending) {
      const OnAnswer oldest = std::move(asked_of_machines_.begin()->second);
      asked_of_machines_.erase(asked_of_machines_.begin());
      queue_.Post([oldest] { oldest(Fail(Errc::kTimeout, "too many requests are unanswered")); });
    }
    const unsigned long number = ++last_number_;
    envelope.message.tag = "i" + std::to_string(number);
    asked_of_machines_.emplace_hint(asked_of_machines_.end(), number, std::move(envelope.done));
  }
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
  if (to == kHub && !said.tag.empty()) {
    const auto asked = asked_of_machines_.find(NumberOf(said.tag));
    if (asked == asked_of_machines_.end()) return;
    const OnAnswer done = std::move(asked->second);
    asked_of_machines_.erase(asked);
    const bool refused = said.slot.ends_with(".error");
    return queue_.Post([done, refused, value = said.value] {
      refused ? done(Fail(Errc::kUnavailable, value)) : done(value);
    });
  }
  Message message = said;
  message.from = machine;
  if (to != kHub) {
    if (Peer* const peer = directory_.ByKey(to)) outbox_.Send(*peer, message, kHub);
    return;
  }
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

void Router::Report(Peer& sender, Message message) {
  if (message.command == Command::kRep && requests_.Resolve(sender, message)) return;
  for (const std::string& name : message.to) {
    if (const auto checked = access_.CheckReceiver(sender.role, name); !checked)
      return outbox_.Complain(sender, checked.error(), message.tag);
  }
  if (sender.kind == PeerKind::kClient && message.slot == "Run" && message.value == "LIVE") {
    sender.kind = PeerKind::kModule;  // a module that came by a socket
    if (on_module_) on_module_(sender);
  }
  if (rules_.empty()) return ReportNow(sender, std::move(message));
  if (message.to.empty()) return ReportByRule(sender, std::move(message));
  for (const std::string& name : message.to) {  // a rule is for one receiver
    Message copy = message;
    copy.to = {name};
    ReportByRule(sender, std::move(copy));
  }
}

void Router::ReportByRule(Peer& sender, Message message) {
  std::string to = message.to.size() == 1 ? message.to.front() : "";
  const std::string before = to;
  const Rules::Outcome outcome =
      rules_.Apply({sender.name, "", sender.role}, to, message, clock_.Now());
  CarryOut(outcome, sender.name);
  if (outcome.dropped) return;
  if (to != before) message.to = {to};
  if (outcome.delay <= vm::Time(0)) return ReportNow(sender, std::move(message));
  lines_.CountHeld(1);
  clock_.After(outcome.delay, [this, key = sender.key, message = std::move(message)] {
    lines_.CountHeld(-1);
    queue_.Post(
        [this, key, message] {
          if (Peer* const peer = directory_.ByKey(key)) ReportNow(*peer, message);
        },
        key);
  });
}

void Router::ReportNow(Peer& sender, Message message) {
  std::set<PeerKey> receivers;
  const bool addressed = !message.to.empty();
  for (const std::string& name : std::exchange(message.to, {})) {
    if (const Peer* const peer = directory_.Find(name)) {
      receivers.insert(peer->key);
    } else if (directory_.Machine(name) == nullptr) {
      outbox_.Complain(sender, {Errc::kUnknownModule, "there is no @" + name, 0});
    }
  }
  if (!addressed) {
    for (const auto& [key, peer] : directory_.peers()) {
      if (key != sender.key &&
          ((sender.kind != PeerKind::kRemote && broadcast_.contains(peer->name)) ||
           peer->subscriptions.contains("*") || peer->subscriptions.contains(sender.name)))
        receivers.insert(key);
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
