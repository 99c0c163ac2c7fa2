#include "agent_manager/hub.h"

#include <algorithm>
#include <charconv>
#include <utility>

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

constexpr PeerKey kHub = 0;
constexpr vm::Time kAnswerLimit =
    std::chrono::minutes(2);        // for a module to answer a peer's request
constexpr int kClockExchanges = 5;  // when a module comes; the quickest one counts
constexpr int kSilentRounds = 4;    // of EndProbes, for a module that has said nothing yet
constexpr int kComplaintsPerSecond = 10;

bool IsReport(const Message& message) {
  return message.command == Command::kRep || message.command == Command::kTell;
}

/// The hub's own tags: "h" and a number.
std::string Tag(unsigned long number) { return "h" + std::to_string(number); }
unsigned long NumberOf(std::string_view tag) {
  unsigned long number = 0;
  if (tag.starts_with('h')) std::from_chars(tag.data() + 1, tag.data() + tag.size(), number);
  return number;
}

std::string SlotOf(const Message& request) {
  return request.slot.empty() ? std::string(vm::CommandName(request.command)) : request.slot;
}

}  // namespace

/// A request that waits for its answer.
struct Hub::Pending {
  PeerKey asker = kHub;
  Message request;
  OnAnswer done;
  vm::TimerId limit = 0;
  bool members_seen = false;  // a group's members have come
};

struct Hub::Peer {
  PeerKey key = 0;
  std::string name;
  PeerKind kind = PeerKind::kClient;
  Dialect dialect = Dialect::kAuto;
  std::unique_ptr<Link> link;
  bool probing = false;
  bool spoken = false;                                // anything at all
  int silent_rounds = 0;                              // EndProbes passed over it
  std::deque<Pending> waiting;                        // said before it was known how to say it
  std::map<unsigned long, Pending> pending;           // by the number in our tag
  std::map<std::string, std::vector<Pending>> asked;  // original dialect: inq, by slot
  std::map<std::string, vm::TimerId> held;            // original dialect: starts held back, by slot
  ClockState clock;
  vm::Time granted{0};  // lockstep: where its clock stands
  std::set<std::string> subscriptions;
  vm::Time complaints_since{0};
  int complaints = 0;
};

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
  if (peers_.size() >= kMaxPeers) {
    link->Close();
    return Fail(Errc::kLimit, "more than " + std::to_string(kMaxPeers) + " peers");
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
    for (auto& [key, peer] : peers_) {
      if (peer->subscriptions.contains("*") || peer->subscriptions.contains(name))
        Send(*peer, message);
    }
  });
}

void Hub::Send(Peer& peer, const Message& message) {
  const std::string line = vm::FormatMessage(message);
  if (log_.enabled())
    log_.Write(clock_.Now(), message.from.empty() ? "AM" : message.from, peer.name, line);
  peer.link->Send(line);
}

void Hub::Complain(Peer& sender, const Error& error) {
  // A flood of bad lines must not become a flood of reports.
  if (clock_.Now() - sender.complaints_since > std::chrono::seconds(1)) {
    sender.complaints_since = clock_.Now();
    sender.complaints = 0;
  }
  if (++sender.complaints > kComplaintsPerSecond) return;
  Notice("@" + sender.name + ": " + vm::FormatError(error));
  if (sender.kind == PeerKind::kModule) return;
  Message rep = vm::Rep("Error", vm::FormatError(error));
  rep.from = "AM";
  Send(sender, rep);
}

void Hub::OnLine(PeerKey key, Result<std::string_view> line) {
  Peer* sender = ByKey(key);
  if (sender == nullptr) return;
  sender->spoken = true;
  if (!line) return Complain(*sender, line.error());
  auto message = vm::ParseMessage(*line);
  if (!message) {
    if (message.error().code != Errc::kEmpty) Complain(*sender, message.error());
    return;
  }
  message->from = sender->name;
  if (IsReport(*message)) return Report(*sender, std::move(*message));
  Route(*sender, std::move(*message));
}

void Hub::Route(Peer& sender, Message message) {
  const std::vector<std::string> receivers =
      message.to.empty() ? std::vector<std::string>{"AM"} : std::exchange(message.to, {});
  const std::string from = std::exchange(message.from, {});
  const PeerKey asker = sender.key;
  for (const std::string& receiver : receivers) Deliver(from, asker, receiver, message, nullptr);
}

void Hub::Ask(const std::string& sender, Message message, OnAnswer done) {
  const std::vector<std::string> receivers = std::exchange(message.to, {});
  for (const std::string& receiver : receivers) Deliver(sender, kHub, receiver, message, done);
}

void Hub::Deliver(const std::string& sender_name, PeerKey asker, const std::string& receiver,
                  const Message& message, OnAnswer done) {
  if (Peer* peer = Find(receiver)) {
    if (log_.enabled())
      log_.Write(clock_.Now(), sender_name, receiver, vm::FormatMessage(vm::To(receiver, message)));
    return Forward(*peer, message, asker, std::move(done));
  }
  const auto machine = internal_.find(receiver);
  if (machine == internal_.end()) {
    return AnswerTo(
        asker, "AM", message,
        Fail(Errc::kUnknownModule, "there is no @" + receiver + " (inq Modules lists them)"), done);
  }
  if (log_.enabled())
    log_.Write(clock_.Now(), sender_name, receiver, vm::FormatMessage(vm::To(receiver, message)));
  if (!done) return machine->second->Handle(message, asker);
  Message tagged = message;
  tagged.tag = "i" + std::to_string(++last_tag_);
  internal_pending_[tagged.tag] = {asker, std::move(done)};
  machine->second->Handle(tagged, asker);
}

void Hub::Forward(Peer& module, Message message, PeerKey asker, OnAnswer done) {
  if (module.probing) {
    if (module.waiting.size() >= kMaxWaitingLines) {
      return AnswerTo(
          asker, module.name, message,
          Fail(Errc::kLimit, "@" + module.name + " is still starting, too much waits for it"),
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
  if (module.pending.size() >= kMaxPending) {
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
  SendBare(module, std::move(message), Tag(number));
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
  module.link->Send(vm::FormatMessage(message));
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
  const auto found = sender.pending.find(NumberOf(message.tag));
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

void Hub::Report(Peer& sender, Message message) {
  if (message.command == Command::kRep && ResolvePending(sender, message)) return;
  if (sender.kind == PeerKind::kClient && message.slot == "Run" && message.value == "LIVE") {
    sender.kind = PeerKind::kModule;  // a module that came by a socket
    Probe(sender);
  }
  std::set<PeerKey> receivers;
  for (const std::string& name : std::exchange(message.to, {})) {
    if (Peer* peer = Find(name)) {
      receivers.insert(peer->key);
    } else if (!internal_.contains(name)) {
      Complain(sender, {Errc::kUnknownModule, "there is no @" + name, 0});
    }
  }
  if (receivers.empty()) {
    for (const auto& [key, peer] : peers_) {
      if (key != sender.key &&
          (broadcast_.contains(peer->name) || peer->subscriptions.contains("*") ||
           peer->subscriptions.contains(sender.name))) {
        receivers.insert(key);
      }
    }
  }
  std::vector<Pending> answered;
  if (const auto asked = sender.asked.find(message.slot); asked != sender.asked.end()) {
    answered = std::move(asked->second);
    sender.asked.erase(asked);
  }
  for (const Pending& pending : answered) {
    if (pending.request.tag.empty() && !pending.done) {
      receivers.insert(pending.asker);
    } else {
      AnswerTo(pending.asker, sender.name, pending.request, message.value, pending.done);
    }
  }
  const std::string line = vm::FormatMessage(message);
  std::string names;
  for (const PeerKey key : receivers) {
    if (Peer* peer = ByKey(key)) {
      peer->link->Send(line);
      if (log_.enabled()) names += (names.empty() ? "" : ",") + peer->name;
    }
  }
  if (log_.enabled()) log_.Write(clock_.Now(), sender.name, names, line);
  if (on_report_) on_report_(sender.name, message);
}

// Clocks ----------------------------------------------------------------------------------------

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
  question.tag = Tag(number);
  peer.link->Send(vm::FormatMessage(question));
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
  const vm::Time now = clock_.Now();
  const vm::Time delay = now - asked_at;
  // The quickest exchange tells most; an old one counts for less, since clocks drift apart.
  const vm::Time aged = peer.clock.delay + peer.clock.delay / 8;
  if (peer.clock.known && delay > aged) {
    peer.clock.delay = aged;
    return;
  }
  peer.clock = {true, *theirs - (asked_at + delay / 2), delay};
}

void Hub::MeasureClock(Peer& peer, int exchanges) {
  if (exchanges <= 0) return;
  Forward(
      peer, vm::Inq("Clock"), kHub,
      [this, key = peer.key, asked_at = clock_.Now(), exchanges](const Result<std::string>& value) {
        Peer* answering = ByKey(key);
        if (answering == nullptr || !value) return;
        SampleClock(*answering, asked_at, *value);
        MeasureClock(*answering, exchanges - 1);
      });
}

void Hub::MeasureClocks() {
  for (const PeerKey key : ModernModules()) MeasureClock(*ByKey(key), 2);
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
  request.tag = Tag(number);
  dirty_.erase(key);
  peer->granted = grant;
  peer->link->Send(vm::FormatMessage(request));
}

// Names -----------------------------------------------------------------------------------------

bool Hub::IsPresent(std::string_view name) const { return Find(name) != nullptr; }
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
