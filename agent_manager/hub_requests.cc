// Requests on their way to modules, and their answers.

#include <utility>

#include "agent_manager/hub.h"
#include "agent_manager/hub_peer.h"
#include "vm_protocol/core/client.h"
#include "vm_protocol/core/start_time.h"

namespace am {

using vm::Command;
using vm::Errc;
using vm::Error;
using vm::Fail;
using vm::Message;
using vm::Result;

namespace {

constexpr vm::Time kAnswerLimit =
    std::chrono::minutes(2);  // for a module to answer a peer's request

std::string SlotOf(const Message& request) {
  return request.slot.empty() ? std::string(vm::CommandName(request.command)) : request.slot;
}

}  // namespace

void Hub::Forward(Peer& module, Message message, PeerKey asker, OnAnswer done) {
  const bool of_its_clock = asker == kHub && message.slot == "Clock";
  if (module.probing || (module.measuring && !of_its_clock) || AwaitClock(module, message)) {
    if (module.waiting.size() >= limits_.waiting) {
      return AnswerTo(
          asker, module.name, message,
          Fail(Errc::kLimit, "@" + module.name + " is still being asked, too much waits for it"),
          done);
    }
    module.waiting.push_back({asker, std::move(message), std::move(done)});
    return;
  }
  if (module.dialect == Dialect::kOriginal)
    return ForwardOriginal(module, std::move(message), asker, done);
  const bool modern = module.dialect == Dialect::kModern;
  if (!modern && message.tag.empty() && !done && message.command != Command::kInq)
    return SendBare(module, std::move(message), "");
  if (modern && !module.clock.known && HoldStart(module, message)) {
    return AnswerTo(asker, module.name, message, message.value, done);
  }
  if (modern && message.command == Command::kSet && message.value.starts_with('@')) {
    if (const auto start = vm::ParseStartTime(message.value);
        start && start->kind == vm::StartTime::Kind::kAt) {
      message.value =
          "@" + vm::FormatMs(start->time + (lockstep_ ? vm::Time(0) : module.clock.offset));
    }
  }
  if (module.pending.size() >= limits_.pending) {
    const auto oldest = module.pending.begin();
    const Pending dropped = std::move(oldest->second);
    module.pending.erase(oldest);
    clock_.Cancel(dropped.limit);
    AnswerTo(dropped.asker, module.name, dropped.request,
             Fail(Errc::kTimeout, "@" + module.name + " leaves too many requests unanswered"),
             dropped.done);
  }
  const unsigned long number = ++last_tag_;
  const bool limited = !done;  // macros and the clock have their own limits
  module.pending[number] = {asker, message, std::move(done)};
  if (limited) {
    module.pending[number].limit =
        clock_.After(kAnswerLimit, [this, key = module.key, number] { GiveUp(key, number); });
  }
  SendBare(module, std::move(message), HubTag(number));
}

bool Hub::AwaitClock(Peer& module, const Message& message) {
  if (module.kind != PeerKind::kRemote || module.asked_clock || message.command != Command::kSet ||
      !message.value.starts_with('@'))
    return false;
  const auto start = vm::ParseStartTime(message.value);
  if (!start || start->kind != vm::StartTime::Kind::kAt) return false;
  module.asked_clock = module.measuring = true;
  clock_.Post([this, key = module.key] {
    if (Peer* peer = ByKey(key)) MeasureClock(*peer, kClockExchanges);
  });
  return true;
}

void Hub::GiveUp(PeerKey key, unsigned long number) {
  Peer* module = ByKey(key);
  if (module == nullptr) return;
  const auto found = module->pending.find(number);
  if (found == module->pending.end()) return;
  const Pending pending = std::move(found->second);
  module->pending.erase(found);
  AnswerTo(pending.asker, module->name, pending.request,
           Fail(Errc::kTimeout,
                "@" + module->name + " has not answered for " + vm::FormatMs(kAnswerLimit) + " ms"),
           pending.done);
}

void Hub::SendBare(Peer& module, Message message, const std::string& tag) {
  message.tag = tag;
  if (lockstep_ && module.clock.known && module.granted < clock_.Now()) {
    // Nothing may reach a module before its clock stands where ours does.
    AskClock(module.key, clock_.Now(), [](const Result<std::string>&) {});
  }
  if (module.clock.known) dirty_.insert(module.key);
  Write(module, vm::FormatMessage(message));
}

void Hub::ForwardOriginal(Peer& module, Message message, PeerKey asker, const OnAnswer& done) {
  // It knows neither tags nor errors: a question is paired with the next report of that slot,
  // anything else counts as done when it is sent.
  if (message.command == Command::kInq) {
    module.asked[message.slot].push_back({asker, message, done});
    return SendBare(module, std::move(message), "");
  }
  const Message request = message;
  if (!HoldStart(module, message)) SendBare(module, std::move(message), "");
  AnswerTo(asker, module.name, request, request.value, done);
}

bool Hub::HoldStart(Peer& module, Message& message) {
  if (message.command != Command::kSet) return false;
  if (const auto held = module.held.find(message.slot); held != module.held.end()) {
    clock_.Cancel(held->second);  // STOP, or a new start, takes the place of the one held
    module.held.erase(held);
    --held_;
  }
  if (!message.value.starts_with('@')) return false;
  const auto start = vm::ParseStartTime(message.value);
  if (!start || start->kind != vm::StartTime::Kind::kAt) return false;
  ++held_;
  module.held[message.slot] = clock_.At(start->time, [this, key = module.key, slot = message.slot] {
    Peer* peer = ByKey(key);
    if (peer == nullptr) return;
    peer->held.erase(slot);
    --held_;
    SendBare(*peer, vm::Set(slot, "NOW"), "");
  });
  return true;
}

void Hub::AnswerTo(PeerKey asker, const std::string& from, const Message& request,
                   const Result<std::string>& result, const OnAnswer& done) {
  if (done) return done(result);
  Peer* peer = ByKey(asker);
  if (peer == nullptr) return;
  if (result && request.tag.empty() && request.command != Command::kInq) return;
  Message rep = result ? vm::Rep(SlotOf(request), *result)
                       : vm::Rep(SlotOf(request) + ".error", vm::FormatError(result.error()));
  rep.tag = request.tag;
  rep.from = from;
  Send(*peer, rep);
}

bool Hub::ResolvePending(Peer& sender, const Message& message) {
  if (message.tag.empty()) return false;
  const auto found = sender.pending.find(HubTagNumber(message.tag));
  if (found == sender.pending.end()) return true;  // late, or not ours: nobody waits for it
  const std::string slot = SlotOf(found->second.request);
  const bool refused = message.slot == slot + ".error" || message.slot == "Error";
  if (!refused && message.slot != slot) {
    found->second.members_seen = true;  // a member of a group, before the answer itself
    if (Peer* asker = ByKey(found->second.asker)) {
      Message member = message;
      member.tag = found->second.request.tag;
      member.from = sender.name;
      Send(*asker, member);
    }
    return true;
  }
  const Pending pending = std::move(found->second);
  sender.pending.erase(found);
  clock_.Cancel(pending.limit);
  if (!refused) {
    // A group has no value of its own; its tagged end is only for those who asked with a tag.
    if (pending.members_seen && pending.request.tag.empty() && !pending.done) return true;
    AnswerTo(pending.asker, sender.name, pending.request, message.value, pending.done);
    return true;
  }
  AnswerTo(pending.asker, sender.name, pending.request,
           std::unexpected(vm::ParseError(message.value)), pending.done);
  return true;
}

}  // namespace am
