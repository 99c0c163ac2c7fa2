#include "agent_manager/routing/outbox.h"

#include <utility>

#include "agent_manager/routing/own_names.h"

namespace am {

using vm::Message;
using vm::Result;

namespace {

constexpr int kComplaintsPerSecond = 10;

}  // namespace

std::string SlotOf(const Message& request) {
  return request.slot.empty() ? std::string(vm::CommandName(request.command)) : request.slot;
}

Outbox::Outbox(vm::Scheduler& clock, SessionLog& log, Directory& directory,
               BackPressure& back_pressure, WorkQueue& queue)
    : clock_(clock),
      log_(log),
      directory_(directory),
      back_pressure_(back_pressure),
      queue_(queue) {}

void Outbox::Notice(const std::string& text, PeerKey about) const {
  if (on_notice_) on_notice_(text, about);
}

void Outbox::Deliver(Peer& receiver, const Outgoing& outgoing, PeerKey commander) {
  if (receiver.flow.cut_off) return;
  if (before_sending_) before_sending_(receiver);
  ++receiver.traffic.messages_out;
  receiver.link->Send(outgoing);
  receiver.traffic.bytes_out += outgoing.line().size() + 1;
  back_pressure_.AfterSend(receiver, commander);
}

void Outbox::Write(Peer& receiver, const Message& message, PeerKey commander) {
  Deliver(receiver, Outgoing(message), commander);
}

void Outbox::Send(Peer& receiver, const Message& message, PeerKey commander) {
  const Outgoing outgoing(message);
  if (log_.enabled())
    log_.Write(clock_.Now(), message.from.empty() ? own_name::kHub : message.from, receiver.name,
               outgoing.line());
  Deliver(receiver, outgoing, commander);
}

void Outbox::SendAll(const std::set<PeerKey>& receivers, const Message& message,
                     PeerKey commander) {
  const Outgoing outgoing(message);
  std::string names;
  for (const PeerKey key : receivers) {
    Peer* const peer = directory_.ByKey(key);
    if (peer == nullptr) continue;
    Deliver(*peer, outgoing, commander);
    if (log_.enabled()) names += (names.empty() ? "" : ",") + peer->name;
  }
  if (log_.enabled()) log_.Write(clock_.Now(), message.from, names, outgoing.line());
}

void Outbox::Answer(PeerKey asker, const std::string& from, const Message& request,
                    const Result<std::string>& result, const OnAnswer& done) {
  if (done) return queue_.Post([done, result] { done(result); });
  Peer* const peer = directory_.ByKey(asker);
  if (peer == nullptr) return;
  if (result && request.tag.empty() && request.command != vm::Command::kInq) return;
  Message rep = result ? vm::Rep(SlotOf(request), *result)
                       : vm::Rep(SlotOf(request) + ".error", vm::FormatError(result.error()));
  rep.tag = request.tag;
  rep.from = from;
  Send(*peer, rep, kHub);
}

bool Outbox::CountComplaint(Peer& sender, const vm::Error& error) {
  ++sender.traffic.refused;
  ComplaintCount& complaints = sender.complaints;
  if (clock_.Now() - complaints.since > std::chrono::seconds(1)) complaints = {clock_.Now(), 0};
  const bool flood = ++complaints.count > kComplaintsPerSecond;
  if (!flood) Notice("@" + sender.name + ": " + vm::FormatError(error), sender.key);
  return flood;
}

void Outbox::Complain(Peer& sender, const vm::Error& error, const std::string& tag) {
  const bool flood = CountComplaint(sender, error);
  if (sender.kind == PeerKind::kModule || sender.kind == PeerKind::kRemote) return;
  if (flood && tag.empty()) return;  // who asked with a tag waits for an answer
  Message rep = vm::Rep("Error", vm::FormatError(error));
  rep.tag = tag;
  rep.from = own_name::kHub;
  Send(sender, rep, kHub);
}

}  // namespace am
