// Who gets what: lines in, lines out.

#include <utility>

#include "agent_manager/hub.h"
#include "agent_manager/hub_peer.h"

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

}  // namespace

void Hub::OnLine(PeerKey key, Result<std::string_view> line) {
  Peer* sender = ByKey(key);
  if (sender == nullptr) return;
  sender->spoken = true;
  ++sender->traffic.messages_in;
  const std::size_t bytes = line ? line->size() + 1 : 0;
  sender->traffic.bytes_in += bytes;
  Throttle(*sender, bytes);
  if (!line) return Complain(*sender, line.error());
  auto message = vm::ParseMessage(*line);
  if (!message) {
    if (message.error().code != Errc::kEmpty) Complain(*sender, message.error());
    return;
  }
  message->from = sender->name;
  const PeerKey before = std::exchange(speaking_, key);
  const bool report = IsReport(*message);
  const bool commanded = std::exchange(commanding_, !report);
  if (report) {
    Report(*sender, std::move(*message));
  } else {
    Route(*sender, std::move(*message));
  }
  speaking_ = before;
  commanding_ = commanded;
}

void Hub::Route(Peer& sender, Message message) {
  const std::vector<std::string> receivers =
      message.to.empty() ? std::vector<std::string>{"AM"} : std::exchange(message.to, {});
  const std::string from = std::exchange(message.from, {});
  const PeerKey asker = sender.key;
  for (const std::string& receiver : receivers) Deliver(from, asker, receiver, message, nullptr);
}

void Hub::Ask(const std::string& sender, Message message, const OnAnswer& done) {
  const std::vector<std::string> receivers = std::exchange(message.to, {});
  for (const std::string& receiver : receivers) Deliver(sender, kHub, receiver, message, done);
}

void Hub::Deliver(const std::string& sender_name, PeerKey asker, const std::string& receiver,
                  const Message& message, OnAnswer done) {
  if (rules_.empty()) return DeliverNow(sender_name, asker, receiver, message, std::move(done));
  DeliverByRule(sender_name, asker, receiver, message, std::move(done));
}

void Hub::DeliverNow(const std::string& sender_name, PeerKey asker, const std::string& receiver,
                     const Message& message, OnAnswer done) {
  if (Peer* peer = Find(receiver)) {
    if (log_.enabled())
      log_.Write(clock_.Now(), sender_name, receiver, vm::FormatMessage(vm::To(receiver, message)));
    return Forward(*peer, message, asker, std::move(done));
  }
  const auto machine = internal_.find(receiver);
  if (machine == internal_.end()) {
    const Result<bool> attached = on_unknown_ ? on_unknown_(receiver) : Result<bool>(false);
    if (!attached) return AnswerTo(asker, "AM", message, std::unexpected(attached.error()), done);
    if (*attached && IsPresent(receiver))
      return DeliverNow(sender_name, asker, receiver, message, std::move(done));
    return AnswerTo(
        asker, "AM", message,
        Fail(Errc::kUnknownModule, "there is no @" + receiver + " (inq Modules lists them)"), done);
  }
  if (log_.enabled())
    log_.Write(clock_.Now(), sender_name, receiver, vm::FormatMessage(vm::To(receiver, message)));
  if (const auto counted = CountDefinition(asker, message); !counted)
    return AnswerTo(asker, receiver, message, std::unexpected(counted.error()), done);
  if (!done) return machine->second->Handle(message, asker);
  Message tagged = message;
  tagged.tag = "i" + std::to_string(++last_tag_);
  internal_pending_[tagged.tag] = {asker, std::move(done)};
  machine->second->Handle(tagged, asker);
}

void Hub::Report(Peer& sender, Message message) {
  if (message.command == Command::kRep && ResolvePending(sender, message)) return;
  if (sender.kind == PeerKind::kClient && message.slot == "Run" && message.value == "LIVE") {
    sender.kind = PeerKind::kModule;  // a module that came by a socket
    Probe(sender);
  }
  if (rules_.empty()) return ReportNow(sender, std::move(message));
  ReportByRule(sender, std::move(message));
}

void Hub::ReportNow(Peer& sender, Message message) {
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
          ((sender.kind != PeerKind::kRemote && broadcast_.contains(peer->name)) ||
           peer->subscriptions.contains("*") || peer->subscriptions.contains(sender.name))) {
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
  SendAll(receivers, message);
  if (on_report_) on_report_(sender.name, message);
}

}  // namespace am
